// SPDX-License-Identifier: Apache-2.0
// Reads a model from the daemon's HTTP API: one request for the model's head, and one URL per chunk,
// without Range requests. With a token, it also reads models that are not public. The chunk URLs of
// such a model start with the model's own URL.
import { headRequest, kPresentation, type FirstRequest } from "./first-request.ts";
import { readAll, unreachable, type ByteRange, type Source } from "./source.ts";
import { DamagedError, ModelError } from "./types.ts";

export class ApiSource implements Source {
  presentation = "";

  /**
   * `api` is the URL of /api/v1 without a trailing slash. `first` is the response to a request for the head, if that request was
   * already sent.
   */
  constructor(
    private readonly api: string,
    private readonly id: string,
    private readonly token = "",
    private readonly first?: Promise<Response | undefined>,
  ) {}

  head(signal: AbortSignal): Promise<Uint8Array> {
    const keep = ({ headers }: Response) => (this.presentation = headers.get(kPresentation) ?? "");
    return this.#get(headRequest(this.api, this.id, this.token), "the model", signal, keep);
  }

  async getBytes(range: ByteRange, signal: AbortSignal): Promise<Uint8Array> {
    if (!range.sha256) throw new ModelError("the daemon sent an incomplete head: reload the page");
    const { headers } = headRequest(this.api, this.id, this.token);
    const url = `${this.api}${this.token && `/models/${this.id}`}/chunks/${range.sha256}`;
    const bytes = await this.#get({ url, headers }, "a part of the model", signal);
    if (bytes.length === range.length) return bytes;
    throw new DamagedError(`a part of the model has ${bytes.length} bytes instead of ${range.length}`);
  }

  /** Does nothing, because each request has its own abort signal. */
  close(): void {}

  /** Only the request for the head has `look`, which gets the response before its body is read. That response may already be in `first`. */
  async #get({ url, headers }: FirstRequest, what: string, signal: AbortSignal, look?: (response: Response) => void): Promise<Uint8Array> {
    try {
      const response = (look && (await this.first)) ?? (await fetch(url, { signal, headers }));
      look?.(response);
      return await readAll(response, what);
    } catch (error) {
      throw unreachable(error, what);
    }
  }
}
