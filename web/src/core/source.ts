// SPDX-License-Identifier: Apache-2.0
// Where the bytes of a model come from: the daemon's interface, or a bare .pmesh on any host.
import { FileSource } from "./file-source.ts";
import { ApiSource } from "./api-source.ts";
import { StreamSource } from "./stream-source.ts";
import { ModelError, UnreachableError, type Want } from "./types.ts";

/** How the daemon is asked: a URL per chunk, or a stream. "auto" is "http". */
export type Transport = "auto" | "http" | "ws";

export interface ByteRange {
  /** From the start of the .pmesh file. */
  offset: number;
  length: number;
  /** The content's name, where it has one: 64 hexadecimal digits. */
  sha256?: string;
  /** Of a chunk. */
  level?: number;
  region?: number;
}

export interface Source {
  /** The first bytes of the file: the header and, if that is one request, the base mesh. */
  head(signal: AbortSignal): Promise<Uint8Array>;
  /** Exactly `range.length` bytes. Rejects with ModelError, or AbortError when aborted. */
  getBytes(range: ByteRange, signal: AbortSignal): Promise<Uint8Array>;
  /** Tells a source that sends by itself what will be asked for; `have` is what need not come. */
  want?(want: Want, have: number[]): void;
  /** Ends what is under way. */
  close(): void;
}

/** The source for the URL of a .pmesh file, of a model page or of an API model; a token goes to the daemon alone. */
export function openSource(url: string, transport: Transport, token: string): Source {
  const address = new URL(url);
  // A model's id has no dot: /models/bust.pmesh is a file in a folder of that name.
  const model = /^(.*?)\/(?:api\/v1\/)?models\/([^/.]+)\/?$/.exec(address.pathname);
  if (!model) return new FileSource(url);
  const api = `${address.origin}${model[1]}/api/v1`, id = model[2] ?? "";
  return transport === "ws" && !token ? new StreamSource(api, id) : new ApiSource(api, id, token);
}

export async function readAll(response: Response, what: string): Promise<Uint8Array> {
  if (!response.ok) throw refused(response.status, what);
  return new Uint8Array(await response.arrayBuffer());
}

export function refused(status: number, what: string): ModelError {
  if (status === 429 || status >= 500) return new UnreachableError(`${what} was refused with status ${status}: try again later`);
  const reason = status === 404 ? "is not there (404): check the address" : `was refused with status ${status}`;
  return new ModelError(`${what} ${reason}`);
}

export function unreachable(error: unknown, what: string): unknown {
  if (error instanceof ModelError || (error as Error).name === "AbortError") return error;
  return new UnreachableError(`${what} cannot be reached: check the connection and try again`);
}
