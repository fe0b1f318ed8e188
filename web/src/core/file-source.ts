// SPDX-License-Identifier: Apache-2.0
// Reads a plain .pmesh file from any static host. If the host supports Range requests, fetches the
// start of the file, and then each part with a request of its own. A host that ignores Range sends
// the whole file once. Bytes are used as they arrive, without waiting for the end of a response.
import { kStart } from "./first-request.ts";
import { refused, unreachable, type ByteRange, type Source } from "./source.ts";
import { ModelError } from "./types.ts";

/**
 * Number of bytes that head() waits for. On a slow line, these bytes may arrive long before the
 * rest of the first response.
 */
const kHead = 1024;

export class FileSource implements Source {
  readonly #life = new AbortController(); // aborts the first download
  #download: Download | undefined;
  #end = 0; // number of bytes that the first download covers; Infinity if it is the whole file

  /**
   * `first` is the response to a request for the first kStart bytes, if that request has been sent.
   */
  constructor(
    private readonly url: string,
    private readonly first?: Promise<Response | undefined>,
  ) {}

  /** Returns the file's first bytes, at most kHead. */
  async head(signal: AbortSignal): Promise<Uint8Array> {
    const response = accepted((await this.first) ?? (await this.#request(0, kStart, this.#life.signal)));
    this.#end = response.status === 206 ? kStart : Infinity;
    this.#download = new Download(response);
    return this.#download.slice(0, kHead, signal);
  }

  async getBytes({ offset, length }: ByteRange, signal: AbortSignal): Promise<Uint8Array> {
    const end = offset + length, border = Math.min(Math.max(offset, this.#end), end);
    const bytes = border === end ? await this.#downloaded(offset, end, signal)
      : border === offset ? await this.#range(offset, end, signal)
      : joined(await Promise.all([this.#downloaded(offset, border, signal), this.#range(border, end, signal)]));
    if (bytes.length === length) return bytes;
    throw new ModelError("the model file ends too early: upload it again");
  }

  close(): void {
    this.#life.abort();
  }

  async #downloaded(begin: number, end: number, signal: AbortSignal): Promise<Uint8Array> {
    return (await this.#download?.slice(begin, end, signal)) ?? new Uint8Array(0);
  }

  async #range(begin: number, end: number, signal: AbortSignal): Promise<Uint8Array> {
    const response = await this.#request(begin, end - begin, signal);
    const bytes = await body(response);
    return response.status === 206 ? bytes : bytes.slice(begin, end);
  }

  async #request(offset: number, length: number, signal: AbortSignal): Promise<Response> {
    const headers = { Range: `bytes=${offset}-${offset + length - 1}` };
    let response;
    try {
      response = await fetch(this.url, { headers, signal });
    } catch (error) {
      throw unreachable(error, "the model file");
    }
    return accepted(response);
  }
}

function accepted(response: Response): Response {
  if (!response.ok) throw refused(response.status, "the model file");
  return response;
}

async function body(response: Response): Promise<Uint8Array> {
  try {
    return new Uint8Array(await response.arrayBuffer());
  } catch (error) {
    throw unreachable(error, "the model file");
  }
}

function joined([first, second]: [Uint8Array, Uint8Array]): Uint8Array {
  const bytes = new Uint8Array(first.length + second.length);
  bytes.set(first);
  bytes.set(second, first.length);
  return bytes;
}

/** A response whose bytes can be used while they arrive. */
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

  /** Resolves to the bytes [begin, end) when they have arrived. Resolves to fewer bytes if the file ends earlier. */
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
