// SPDX-License-Identifier: Apache-2.0
// What went wrong, as the daemon tells it (RFC 9457): what, where, and what is expected there.
export interface Fault {
  parameter: string;
  detail: string;
}

export class Problem extends Error {
  constructor(readonly status: number, readonly title: string, readonly detail = "", readonly faults: Fault[] = [], readonly request = "") {
    super(detail || title);
  }

  /** Of an answer that is no success; a proxy's own page has nothing but its status. */
  static async of(answer: Response): Promise<Problem> {
    const told = (await answer.json().catch(() => ({}))) as { title?: string; detail?: string; errors?: Fault[]; request_id?: string };
    return new Problem(answer.status, told.title ?? answer.statusText, told.detail, told.errors, told.request_id);
  }
}
