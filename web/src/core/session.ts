// SPDX-License-Identifier: Apache-2.0
// Refines one model. Requests from the source the chunks that the planner chooses, several at a time, applies
// them in the planner's order and offers each state for display. A new detail request supersedes the previous
// one before the next chunk is applied. Fetched chunks are kept, so applying them again needs no download.
import { Shown, type Piece } from "./change.ts";
import type { BaseMesh } from "./decoder.ts";
import type { Source } from "./source.ts";
import {
  DamagedError, ModelError, UnreachableError,
  type Change, type Chunk, type Level, type ModelInfo, type Progress, type Surface, type Want,
} from "./types.ts";

/** The part of the decoder (decoder.ts) that a session uses. */
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

/** Receives the changes and reports of a session. */
export interface Sink {
  /** Called when the header and base mesh have arrived; the first surface follows. */
  opened(info: ModelInfo): void;
  /** Displays a change. Resolves when the change is displayed; only then does the session send the next one. */
  show(change: Change, pieces: Piece[]): Promise<void>;
  progress(progress: Progress): void;
  /** Called with the reason when the server does not respond, and with undefined when it responds again. */
  stalled(reason: string | undefined): void;
}

export type RetryDelay = (milliseconds: number) => Promise<void>;

export type BaseDecoder = (bytes: Uint8Array, info: ModelInfo) => Promise<BaseMesh>;

/** Maximum number of concurrent requests. */
const kWindow = 6;
/** Maximum size of header and base mesh, in bytes. */
const kMaxHead = 256 * 1024 * 1024;
/** Milliseconds before the first retry of a failed request. The wait doubles at each retry, up to kLongestWait. */
const kFirstWait = 500, kLongestWait = 15_000;

interface Fetch {
  bytes: Promise<Uint8Array>;
  abort: AbortController;
  isDone: boolean;
}

export class Session {
  readonly #fetches = new Map<number, Fetch>();
  #info: ModelInfo | undefined;
  #turn = 0;
  #showing: Promise<void> | undefined;
  #isStale = false;
  readonly #shown = new Shown();
  #isRenumbered = false; // whether the decoder was reset to the base mesh since the last state was shown
  #isBehind = false; // whether the surface shown is finer than the decoder's surface
  #isStalled = false;

  constructor(
    private readonly source: Source,
    private readonly decoder: ModelDecoder,
    private readonly decodeBase: BaseDecoder,
    private readonly sink: Sink,
    /** Aborted by close(); the caller may have started requests with its signal. */
    private readonly life = new AbortController(),
    private readonly wait: RetryDelay = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds)),
  ) {}

  /**
   * Fetches the header and base mesh. Resolves when the base mesh is displayed; requests no enhancement
   * layer. With `isRestart`, a finer surface is displayed already and stays until a detail request is reached.
   */
  async open(isRestart = false, asked = this.source.head(this.life.signal)): Promise<void> {
    const { signal } = this.life;
    let head = await asked;
    head = await this.#extend(head, this.decoder.headerLength(head));
    const info = (this.#info = this.decoder.open(head));
    const end = info.baseOffset + info.baseLength;
    head = await this.#extend(head, end);
    const base = head.subarray(info.baseOffset, end);
    this.decoder.checkBase(base);
    this.decoder.start(await this.decodeBase(base, info));
    signal.throwIfAborted();
    this.sink.opened(info);
    this.#isBehind = isRestart;
    this.#present();
    await this.#showing;
  }

  /** Refines or coarsens to `want`. Resolves to true when it is reached and shown, to false if superseded. */
  async refine(want: Want): Promise<boolean> {
    const turn = ++this.#turn;
    if (this.decoder.want(want)) this.#isRenumbered = this.#isBehind = true;
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
    this.#isBehind = false;
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

  /** Returns the chunks that the detail request still needs, in the planner's order. */
  #plan(): number[] {
    const plan = [];
    for (let chunk = this.decoder.nextChunk(); chunk !== undefined; chunk = this.decoder.nextChunk()) plan.push(chunk);
    return plan;
  }

  /** Returns the indices of the chunks already fetched, in ascending order. */
  #held(): number[] {
    return [...this.#fetches].flatMap(([chunk, { isDone }]) => (isDone ? [chunk] : [])).sort((a, b) => a - b);
  }

  #fetch(chunk: number): Promise<Uint8Array> {
    const known = this.#fetches.get(chunk);
    if (known) return known.bytes;
    const abort = new AbortController();
    const bytes = this.source.getBytes(this.#chunk(chunk), abort.signal);
    const fetch: Fetch = { bytes, abort, isDone: false };
    this.#fetches.set(chunk, fetch);
    bytes.then(
      () => (fetch.isDone = true),
      () => this.#fetches.get(chunk) === fetch && this.#fetches.delete(chunk),
    );
    return bytes;
  }

  /** Aborts the requests for chunks that are not in `plan`. Fetched chunks are kept; they can be applied again. */
  #abandon(plan: number[]): void {
    const wanted = new Set(plan);
    for (const [chunk, { abort, isDone }] of this.#fetches) {
      if (isDone || wanted.has(chunk)) continue;
      this.#fetches.delete(chunk);
      abort.abort();
    }
  }

  /**
   * Fetches and applies a chunk. Resolves to false if the detail request was superseded meanwhile. If the chunk is
   * damaged, fetches it a second time. If the server cannot be reached, retries until the chunk arrives.
   */
  async #apply(chunk: number, ask: () => void, isCurrent: () => boolean): Promise<boolean> {
    for (let damaged = 0, lost = 0; ; ) {
      try {
        const bytes = await this.#fetch(chunk);
        if (!isCurrent()) return false;
        this.#stall(undefined);
        this.decoder.checkChunk(chunk, bytes);
        this.decoder.apply(chunk, bytes);
        return true;
      } catch (error) {
        if (!isCurrent()) return false;
        this.#fetches.delete(chunk);
        if (error instanceof DamagedError ? ++damaged === 2 : !(error instanceof UnreachableError)) throw error;
        if (error instanceof DamagedError) continue;
        this.#stall((error as Error).message);
        await this.wait(Math.min(kFirstWait * 2 ** lost++, kLongestWait));
        if (!isCurrent()) return false;
        ask();
      }
    }
  }

  #stall(reason: string | undefined): void {
    if (this.#isStalled || reason !== undefined) this.sink.stalled(reason);
    this.#isStalled = reason !== undefined;
  }

  /**
   * Shows the decoder's current state, immediately or after the state that is being displayed. Does nothing while
   * that state is coarser than the surface shown.
   */
  #present(): void {
    if (this.#isBehind) return;
    this.#isStale = true;
    this.#showing ??= this.#show().finally(() => (this.#showing = undefined));
    this.#showing.catch(() => undefined); // callers that wait for the surface receive the error
  }

  async #show(): Promise<void> {
    while (this.#isStale && !this.life.signal.aborted) {
      this.#isStale = false;
      const { change, pieces } = this.#shown.change(this.decoder.surface(), this.decoder.parents, this.#isRenumbered);
      this.#isRenumbered = false;
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

/** Yields to the event loop, so that pending messages (a new detail request, close) are handled. */
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
