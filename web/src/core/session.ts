// SPDX-License-Identifier: Apache-2.0
// One model being refined: asks the source for the chunks that the planner names, several at a
// time, applies them in that order and offers each state for display. A new want supersedes the
// one before at the next chunk; what was fetched is kept, so going back is free of charge.
import { Shown, type Piece } from "./change.ts";
import type { BaseMesh } from "./decoder.ts";
import type { Source } from "./source.ts";
import {
  DamagedError, ModelError, UnreachableError,
  type Change, type Chunk, type Level, type ModelInfo, type Progress, type Surface, type Want,
} from "./types.ts";

/** What a session needs of the WebAssembly decoder (decoder.ts). */
export interface ModelDecoder {
  headerLength(bytes: Uint8Array): number;
  open(header: Uint8Array): ModelInfo;
  checkBase(bytes: Uint8Array): void;
  start(base: BaseMesh): void;
  want(want: Want): boolean;
  nextChunk(): number | undefined;
  checkChunk(chunk: number, bytes: Uint8Array): void;
  apply(chunk: number, bytes: Uint8Array): void;
  trim(): void;
  readonly bytesHeld: number;
  readonly parents: Uint32Array;
  surface(): Surface;
}

/** Where a session shows what it has. */
export interface Sink {
  /** The header and base mesh are here; the first surface follows. */
  opened(info: ModelInfo): void;
  /** Resolves when the change is on display; the next one is sent after that. */
  show(change: Change, pieces: Piece[]): Promise<void>;
  progress(progress: Progress): void;
  /** Nobody answers, and why; undefined once somebody does again. */
  stalled(reason: string | undefined): void;
}

export type Wait = (milliseconds: number) => Promise<void>;

export type BaseDecoder = (bytes: Uint8Array, level: Level) => Promise<BaseMesh>;

/** Requests under way at once. */
const kWindow = 6;
/** Bytes of a header and base mesh that a browser accepts. */
const kMaxHead = 256 * 1024 * 1024;
/** Milliseconds before a lost request is tried again: twice as long each time. */
const kFirstWait = 500, kLongestWait = 15_000;

interface Fetch {
  bytes: Promise<Uint8Array>;
  abort: AbortController;
  done: boolean;
}

export class Session {
  readonly #fetches = new Map<number, Fetch>();
  #info: ModelInfo | undefined;
  #turn = 0;
  #showing: Promise<void> | undefined;
  #stale = false;
  readonly #shown = new Shown();
  #anew = false; // since the last state shown the decoder started over
  #behind = false; // what is shown is further than the decoder
  #stalled = false;

  constructor(
    private readonly source: Source,
    private readonly decoder: ModelDecoder,
    private readonly decodeBase: BaseDecoder,
    private readonly sink: Sink,
    /** Aborted by close(): what the source was asked for already ends with the rest. */
    private readonly life = new AbortController(),
    private readonly wait: Wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds)),
  ) {}

  /** Fetches header and base mesh and shows the base mesh: resolves when it is on display. Requests
   * no enhancement layer. With `again` something finer is on display already, which stays until a
   * want is reached. */
  async open(again = false, asked = this.source.head(this.life.signal)): Promise<void> {
    const { signal } = this.life;
    let head = await asked;
    head = await this.#extend(head, this.decoder.headerLength(head));
    const info = (this.#info = this.decoder.open(head));
    const end = info.baseOffset + info.baseLength;
    head = await this.#extend(head, end);
    const base = head.subarray(info.baseOffset, end);
    this.decoder.checkBase(base);
    this.decoder.start(await this.decodeBase(base, this.#level(0)));
    signal.throwIfAborted();
    this.sink.opened(info);
    this.#behind = again;
    this.#present();
    await this.#showing;
  }

  /** Refines (or coarsens) to `want`. True when it is reached and shown, false when superseded. */
  async refine(want: Want): Promise<boolean> {
    const turn = ++this.#turn;
    if (this.decoder.want(want)) this.#anew = this.#behind = true;
    const plan = this.#plan();
    const total = plan.reduce((sum, chunk) => sum + this.#chunk(chunk).length, this.decoder.bytesHeld);
    const ask = () => this.source.want?.("view" in want ? { view: { ...want.view, bytes: total } } : want, this.#held());
    ask();
    this.#abandon(plan);
    for (let i = 0; i < plan.length; ++i) {
      for (const chunk of plan.slice(i, i + kWindow)) this.#fetch(chunk);
      if (!(await this.#apply(plan[i] as number, ask, () => turn === this.#turn))) return false;
      this.sink.progress({ bytes: this.decoder.bytesHeld, total });
      this.#present();
      await breathe();
      if (turn !== this.#turn) return false;
    }
    this.decoder.trim();
    this.#behind = false;
    this.sink.progress({ bytes: this.decoder.bytesHeld, total });
    this.#present();
    while (this.#showing) await this.#showing;
    return turn === this.#turn;
  }

  close(): void {
    ++this.#turn;
    this.life.abort();
    this.source.close();
    this.#abandon([]);
  }

  async #extend(head: Uint8Array, end: number): Promise<Uint8Array> {
    if (head.length >= end) return head;
    if (end > kMaxHead) throw new ModelError("the model's head is too large for a browser");
    const rest = await this.source.getBytes({ offset: head.length, length: end - head.length }, this.life.signal);
    const joined = new Uint8Array(end);
    joined.set(head);
    joined.set(rest, head.length);
    return joined;
  }

  /** All chunks that are missing, in the planner's order. */
  #plan(): number[] {
    const plan = [];
    for (let chunk = this.decoder.nextChunk(); chunk !== undefined; chunk = this.decoder.nextChunk()) plan.push(chunk);
    return plan;
  }

  /** Chunks that need not come again, ascending. */
  #held(): number[] {
    return [...this.#fetches].flatMap(([chunk, { done }]) => (done ? [chunk] : [])).sort((a, b) => a - b);
  }

  #fetch(chunk: number): Promise<Uint8Array> {
    const known = this.#fetches.get(chunk);
    if (known) return known.bytes;
    const abort = new AbortController();
    const bytes = this.source.getBytes(this.#chunk(chunk), abort.signal);
    const fetch: Fetch = { bytes, abort, done: false };
    this.#fetches.set(chunk, fetch);
    bytes.then(
      () => (fetch.done = true),
      () => this.#fetches.get(chunk) === fetch && this.#fetches.delete(chunk),
    );
    return bytes;
  }

  /** Ends the requests that `plan` has no use for. Finished ones stay: they can be applied again. */
  #abandon(plan: number[]): void {
    const wanted = new Set(plan);
    for (const [chunk, { abort, done }] of this.#fetches) {
      if (done || wanted.has(chunk)) continue;
      this.#fetches.delete(chunk);
      abort.abort();
    }
  }

  /** False where the want was superseded meanwhile. A damaged chunk is fetched once more, a lost
   * one until it comes. */
  async #apply(chunk: number, ask: () => void, current: () => boolean): Promise<boolean> {
    for (let damaged = 0, lost = 0; ; ) {
      try {
        const bytes = await this.#fetch(chunk);
        if (!current()) return false;
        this.#stall(undefined);
        this.decoder.checkChunk(chunk, bytes);
        this.decoder.apply(chunk, bytes);
        return true;
      } catch (error) {
        if (!current()) return false;
        this.#fetches.delete(chunk);
        if (error instanceof DamagedError ? ++damaged === 2 : !(error instanceof UnreachableError)) throw error;
        if (error instanceof DamagedError) continue;
        this.#stall((error as Error).message);
        await this.wait(Math.min(kFirstWait * 2 ** lost++, kLongestWait));
        if (!current()) return false;
        ask();
      }
    }
  }

  #stall(reason: string | undefined): void {
    if (this.#stalled || reason !== undefined) this.sink.stalled(reason);
    this.#stalled = reason !== undefined;
  }

  /** Shows the present state, or as soon as the one on its way to the screen is there; none that is
   * coarser than what is shown, if it is only on the way to something. */
  #present(): void {
    if (this.#behind) return;
    this.#stale = true;
    this.#showing ??= this.#show().finally(() => (this.#showing = undefined));
    this.#showing.catch(() => undefined); // whoever waits for the surface sees the failure
  }

  async #show(): Promise<void> {
    while (this.#stale && !this.life.signal.aborted) {
      this.#stale = false;
      const { change, pieces } = this.#shown.change(this.decoder.surface(), this.decoder.parents, this.#anew);
      this.#anew = false;
      await this.sink.show(change, pieces);
    }
  }

  #chunk(index: number): Chunk {
    return this.#info?.chunks[index] as Chunk;
  }

  #level(index: number): Level {
    const level = this.#info?.levels[index];
    if (!level) throw new ModelError("the model has no levels: publish it again");
    return level;
  }
}

/** Lets messages in: another want, or the end. */
function breathe(): Promise<void> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(0);
  });
}
