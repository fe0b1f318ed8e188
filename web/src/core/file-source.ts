// SPDX-License-Identifier: Apache-2.0
// Reads a plain .pmesh file from any static host. If the host supports Range requests, each part of the file is
// fetched with its own request. A host that ignores Range sends the whole file once; its parts are then used as
// they arrive, without waiting for the end of the file.
import { refused, unreachable, type ByteRange, type Source } from "./source.ts";
import { ModelError } from "./types.ts";

/** Bytes of the first request: enough for the header and base mesh of most models. */
const kHeadBytes = 32 * 1024;

export class FileSource implements Source {
  readonly #life = new AbortController(); // controller that can abort a download of the whole file
  #whole: Download | undefined;
  // First bytes of the file, if the host supports Range; may include the first chunks.
  #head: Uint8Array = new Uint8Array(0);

  constructor(private readonly url: string) {}

  /** Returns the file's first bytes, at most kHeadBytes. */
  async head(signal: AbortSignal): Promise<Uint8Array> {
    const response = await this.#request(0, kHeadBytes, this.#life.signal);
    if (response.status === 206) return (this.#head = await body(response));
    this.#whole = new Download(response);
    return this.#whole.slice(0, kHeadBytes, signal);
  }

  async getBytes({ offset, length }: ByteRange, signal: AbortSignal): Promise<Uint8Array> {
    if (offset + length <= this.#head.length) return this.#head.slice(offset, offset + length);
    const bytes = this.#whole
      ? await this.#whole.slice(offset, offset + length, signal)
      : await this.#range(offset, length, signal);
    if (bytes.length === length) return bytes;
    throw new ModelError("the model file ends too early: upload it again");
  }

  close(): void {
    this.#life.abort();
  }

  async #range(offset: number, length: number, signal: AbortSignal): Promise<Uint8Array> {
    const response = await this.#request(offset, length, signal);
    const bytes = await body(response);
    return response.status === 206 ? bytes : bytes.slice(offset, offset + length);
  }

  async #request(offset: number, length: number, signal: AbortSignal): Promise<Response> {
    const headers = { Range: `bytes=${offset}-${offset + length - 1}` };
    let response;
    try {
      response = await fetch(this.url, { headers, signal });
    } catch (error) {
      throw unreachable(error, "the model file");
    }
    if (!response.ok) throw refused(response.status, "the model file");
    return response;
  }
}

async function body(response: Response): Promise<Uint8Array> {
  try {
    return new Uint8Array(await response.arrayBuffer());
  } catch (error) {
    throw unreachable(error, "the model file");
  }
}

/** A whole file being downloaded. */
class Download {
  #bytes = new Uint8Array(1 << 16);
  #size = 0;
  #hasEnded = false;
  #failure: unknown;
  #wake: (() => void)[] = [];

  constructor(response: Response) {
    this.#read(response).catch((error) => (this.#failure = unreachable(error, "the model file"))).finally(() => {
      this.#hasEnded = true;
      this.#notify();
    });
  }

  /** Resolves to the bytes [begin, end) when they have arrived; fewer if the file ends earlier. */
  async slice(begin: number, end: number, signal: AbortSignal): Promise<Uint8Array> {
    const wake = () => this.#notify();
    signal.addEventListener("abort", wake);
    while (this.#size < end && !this.#hasEnded && !signal.aborted) {
      await new Promise<void>((resolve) => this.#wake.push(resolve));
    }
    signal.removeEventListener("abort", wake);
    signal.throwIfAborted();
    if (this.#size < end && this.#failure) throw this.#failure;
    return this.#bytes.slice(begin, Math.min(end, this.#size));
  }

  async #read(response: Response): Promise<void> {
    const reader = response.body?.getReader();
    for (let part = await reader?.read(); part && !part.done; part = await reader?.read()) {
      this.#append(part.value);
      this.#notify();
    }
  }

  #append(part: Uint8Array): void {
    if (this.#size + part.length > this.#bytes.length) {
      const larger = new Uint8Array(Math.max(2 * this.#bytes.length, this.#size + part.length));
      larger.set(this.#bytes.subarray(0, this.#size));
      this.#bytes = larger;
    }
    this.#bytes.set(part, this.#size);
    this.#size += part.length;
  }

  #notify(): void {
    for (const wake of this.#wake.splice(0)) wake();
  }
}
