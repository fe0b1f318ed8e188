// SPDX-License-Identifier: Apache-2.0
// Reads a model from the daemon's HTTP API: one request for the head, and one URL per chunk,
// without Range requests. With a token, it also reads models that are not public. The chunk URLs of
// such a model start with the model's own URL.
import { readAll, unreachable, type ByteRange, type Source } from "./source.ts";
import { DamagedError, ModelError } from "./types.ts";

export class ApiSource implements Source {
  /** `api` is the URL of /api/v1 without a trailing slash. */
  constructor(
    private readonly api: string,
    private readonly id: string,
    private readonly token = "",
  ) {}

  head(signal: AbortSignal): Promise<Uint8Array> {
    return this.#get(`${this.api}/models/${this.id}/head`, "the model", signal);
  }

  async getBytes(range: ByteRange, signal: AbortSignal): Promise<Uint8Array> {
    if (!range.sha256) throw new ModelError("the daemon sent an incomplete head: reload the page");
    const bytes = await this.#get(`${this.api}${this.token && `/models/${this.id}`}/chunks/${range.sha256}`, "a part of the model", signal);
    if (bytes.length === range.length) return bytes;
    throw new DamagedError(`a part of the model has ${bytes.length} bytes instead of ${range.length}`);
  }

  /** Does nothing, because each request has its own abort signal. */
  close(): void {}

  async #get(url: string, what: string, signal: AbortSignal): Promise<Uint8Array> {
    try {
      return await readAll(await fetch(url, { signal, headers: this.token ? { Authorization: `Bearer ${this.token}` } : {} }), what);
    } catch (error) {
      throw unreachable(error, what);
    }
  }
}
