// SPDX-License-Identifier: Apache-2.0
// The interface of the sources that deliver a model's bytes, and the errors that all sources share.
import { ModelError, UnreachableError, type Want } from "./types.ts";

/** How to fetch from the daemon: one URL per chunk ("http"), or a WebSocket stream ("ws"). "auto" means "http". */
export type Transport = "auto" | "http" | "ws";

export interface ByteRange {
  /** Position in bytes from the start of the .pmesh file. */
  offset: number;
  length: number;
  /** SHA-256 of the content, if known: 64 hexadecimal digits. */
  sha256?: string;
  /** Level and region, if the range is a chunk. */
  level?: number;
  region?: number;
}

export interface Source {
  /** The presentation of the model as JSON, after head() has resolved. Empty or undefined if there is none. */
  presentation?: string;
  /** Resolves to the start of the file: the header, and also base mesh and first pictures if one request can fetch all. */
  head(signal: AbortSignal): Promise<Uint8Array>;
  /**
   * Resolves to exactly `range.length` bytes. Rejects with ModelError on a failure, and with
   * AbortError if aborted.
   */
  getBytes(range: ByteRange, signal: AbortSignal): Promise<Uint8Array>;
  /**
   * Sends the detail request to the server, which then sends the chunks that are needed. `have`
   * lists the indices of the chunks that the client already has. Sources that fetch chunks one by
   * one do not have this function.
   */
  want?(want: Want, have: number[]): void;
  /** Ends transfers in progress. */
  close(): void;
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
