// SPDX-License-Identifier: Apache-2.0
// Errors in the form in which the daemon reports them [RFC9457]. An error may list faults. Each
// fault names a parameter and describes what is wrong with it.
export interface ParameterFault {
  parameter: string;
  detail: string;
}

export class Problem extends Error {
  constructor(readonly status: number, readonly title: string, readonly detail = "", readonly faults: ParameterFault[] = [], readonly request = "") {
    super(detail || title);
  }

  /**
   * Reads an error response. If the response does not come from the daemon but, for example, from a
   * proxy, the problem has only the status and its text.
   */
  static async of(answer: Response): Promise<Problem> {
    const body = (await answer.json().catch(() => ({}))) as { title?: string; detail?: string; errors?: ParameterFault[]; request_id?: string };
    return new Problem(answer.status, body.title ?? answer.statusText, body.detail, body.errors, body.request_id);
  }
}
