// SPDX-License-Identifier: Apache-2.0
// Client of the daemon's WebSocket stream (server/stream/PROTOCOL.md). The server sends the model's
// head first. Then it sends all chunks that a detail request needs, without a request per chunk.
// Chunks that the stream does not send are fetched over HTTP.
import { ApiSource } from "./api-source.ts";
import type { ByteRange, Source } from "./source.ts";
import type { Want } from "./types.ts";

const kSliceHeader = 16;
const kMaxChunk = 64 * 1024 * 1024;
/** Maximum number of ranges per `have` message. The server limits the size of a message. */
const kMostRanges = 2048;
const kHead = "0/0";

/** A partly received chunk. Its slices arrive in order, possibly with slices of other chunks between them. */
interface PartialChunk {
  bytes: Uint8Array;
  filled: number;
}

interface Waiter {
  take(bytes: Uint8Array): void;
  /** Called if the stream will not send the chunk. */
  miss(): void;
}

export class StreamSource implements Source {
  presentation = "";
  readonly #http: ApiSource;
  readonly #arrived = new Map<string, Uint8Array>();
  readonly #taken = new Set<string>();
  readonly #waiting = new Map<string, Waiter>();
  #socket: WebSocket | undefined;
  #queue: object[] = [];
  #isBusy = false; // whether the server is still sending chunks for the current detail request
  #turn = 0; // number of the current detail request
  #sha256 = ""; // hash of the model's file
  readonly #parts = new Map<string, PartialChunk>();

  constructor(
    private readonly api: string,
    private readonly id: string,
  ) {
    this.#http = new ApiSource(api, id);
  }

  async head(signal: AbortSignal): Promise<Uint8Array> {
    this.#connect("?head=true");
    const head = await this.#wait(kHead, signal);
    this.#arrived.delete(kHead);
    if (head) return head;
    const bytes = await this.#http.head(signal);
    this.presentation = this.#http.presentation;
    return bytes;
  }

  want(want: Want, have: number[]): void {
    if (!this.#socket || this.#socket.readyState > WebSocket.OPEN) this.#connect();
    this.#isBusy = true;
    const held = pairs(have);
    for (let at = 0; at < held.length; at += kMostRanges) this.#send({ type: "have", chunks: held.slice(at, at + kMostRanges) });
    this.#send({ type: "want", turn: ++this.#turn, ...want });
  }

  async getBytes(range: ByteRange, signal: AbortSignal): Promise<Uint8Array> {
    if (range.level === undefined) return this.#http.getBytes(range, signal); // the stream sends only chunks
    const key = `${range.level}/${range.region}`;
    const isStreamed = this.#isBusy && !this.#taken.has(key);
    const bytes = this.#arrived.get(key) ?? (isStreamed ? await this.#wait(key, signal) : undefined);
    if (bytes?.length !== range.length) return this.#http.getBytes(range, signal);
    this.#arrived.delete(key);
    this.#taken.add(key);
    return bytes;
  }

  close(): void {
    this.#socket?.close(1000);
  }

  #connect(query = ""): void {
    const url = new URL(`${this.api}/models/${this.id}/stream${query}`);
    url.protocol = url.protocol.replace("http", "ws");
    const socket = (this.#socket = new WebSocket(url, "pmesh.v1"));
    this.#queue = [];
    this.#parts.clear();
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.#queue.splice(0).forEach((message) => this.#send(message));
    socket.onmessage = ({ data }) => {
      try {
        if (typeof data === "string") this.#receiveText(data);
        else this.#receive(data as ArrayBuffer);
      } catch {
        socket.close(1000); // the message is not part of pmesh.v1, so the remaining chunks are fetched over HTTP
      }
    };
    socket.onclose = () => socket === this.#socket && this.#miss();
  }

  #send(message: object): void {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
    else this.#queue.push(message);
  }

  #receiveText(text: string): void {
    const message = JSON.parse(text) as { type?: unknown; turn?: unknown; sha256?: unknown; presentation?: unknown };
    if (message.type === "model") {
      // If the hash differs, the file was replaced, and the old file's chunks do not fit the new
      // file.
      if (this.#sha256 && message.sha256 !== this.#sha256) return this.#socket?.close(1000);
      this.#sha256 = String(message.sha256);
      this.presentation = String(message.presentation ?? "");
    }
    if (message.type === "done" && message.turn === this.#turn) this.#miss();
  }

  #receive(data: ArrayBuffer): void {
    const view = new DataView(data);
    const key = `${view.getUint16(2, true)}/${view.getUint32(4, true)}`;
    const [offset, length] = [view.getUint32(8, true), view.getUint32(12, true)];
    const slice = new Uint8Array(data, kSliceHeader);
    if (length > kMaxChunk) return this.#socket?.close(1000);
    if (offset === 0) this.#parts.set(key, { bytes: new Uint8Array(length), filled: 0 });
    const part = this.#parts.get(key);
    if (part?.filled !== offset || offset + slice.length > part.bytes.length) return this.#socket?.close(1000);
    part.bytes.set(slice, offset);
    part.filled += slice.length;
    this.#send({ type: "ack", bytes: slice.length });
    if (part.filled < part.bytes.length) return;
    this.#parts.delete(key);
    this.#deliver(key, part.bytes);
  }

  #deliver(key: string, bytes: Uint8Array): void {
    this.#arrived.set(key, bytes);
    this.#waiting.get(key)?.take(bytes);
  }

  /** Called when the stream sends no more chunks for now. Fetches the missing chunks over HTTP. */
  #miss(): void {
    this.#isBusy = false;
    for (const waiter of this.#waiting.values()) waiter.miss();
  }

  #wait(key: string, signal: AbortSignal): Promise<Uint8Array | undefined> {
    return new Promise((resolve, reject) => {
      const end = (settle: () => void) => {
        if (this.#waiting.get(key) === waiter) this.#waiting.delete(key);
        signal.removeEventListener("abort", aborted);
        settle();
      };
      const aborted = () => end(() => reject(signal.reason as Error));
      const waiter: Waiter = { take: (bytes) => end(() => resolve(bytes)), miss: () => end(() => resolve(undefined)) };
      signal.addEventListener("abort", aborted);
      this.#waiting.set(key, waiter);
    });
  }
}

/** Converts ascending indices to inclusive [first, last] ranges. */
export function pairs(indices: number[]): [number, number][] {
  const out: [number, number][] = [];
  for (const index of indices) {
    const last = out[out.length - 1];
    if (last && last[1] + 1 === index) last[1] = index;
    else out.push([index, index]);
  }
  return out;
}
