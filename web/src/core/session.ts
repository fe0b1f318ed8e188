// SPDX-License-Identifier: Apache-2.0
// Refines one model. The planner chooses the chunks. The session requests them from the source,
// several at a time, applies them in the planner's order, and offers each state for display. A new
// detail request replaces the previous one before the next chunk is applied. Fetched chunks are
// kept, so applying them again needs no download.
import { Shown, type Piece } from "./change.ts";
import { presentationOf } from "./presentation.ts";
import type { Source } from "./source.ts";
import {
  DamagedError, ModelError, UnreachableError,
  type Change, type Chunk, type Level, type ModelInfo, type Picture, type Progress, type Surface, type TextureInfo, type Want,
} from "./types.ts";

/** The part of the decoder (decoder.ts) that a session uses. */
export interface ModelDecoder {
  headerLength(bytes: Uint8Array): number;
  open(header: Uint8Array): ModelInfo;
  checkBase(bytes: Uint8Array): void;
  checkAtlas(bytes: Uint8Array): void;
  checkPicture(picture: number, bytes: Uint8Array): void;
  start(base: Uint8Array, atlas: Uint8Array): void;
  want(want: Want): boolean;
  nextChunk(): number | undefined;
  checkChunk(chunk: number, bytes: Uint8Array): void;
  apply(chunk: number, bytes: Uint8Array): void;
  trim(): void;
  readonly bytesHeld: number;
  readonly parents: Uint32Array;
  surface(): Surface;
}

/** Receives the changes and the reports of a session. */
export interface Sink {
  /** Called when the model's head (header, base mesh, first pictures) has arrived. Calls of picture() and show() follow. */
  opened(info: ModelInfo): void;
  /**
   * Decodes a picture and displays it in a size of `side` by `side` pixels. Resolves when the picture is
   * decoded.
   */
  picture(index: number, picture: Picture, side: number, bytes: Uint8Array): Promise<void>;
  /** Displays a change. Resolves when the change is displayed. The session sends the next change only after that. */
  show(change: Change, pieces: Piece[]): Promise<void>;
  progress(progress: Progress): void;
  /** Called with a reason when the server stops responding, and with undefined when it responds again. */
  stalled(reason: string | undefined): void;
}

export type RetryDelay = (milliseconds: number) => Promise<void>;

/** Maximum number of requests in progress at the same time. */
const kWindow = 6;
/** Maximum size of a model's head (header, base mesh, first pictures), in bytes. */
const kMaxHead = 256 * 1024 * 1024;
/**
 * Milliseconds before the first retry of a failed request. The waiting time doubles at each retry,
 * up to kLongestWait.
 */
const kFirstWait = 500, kLongestWait = 15_000;

interface Fetch {
  bytes: Promise<Uint8Array>;
  abort: AbortController;
  isDone: boolean;
}

export class Session {
  readonly #fetches = new Map<number, Fetch>();
  #info: ModelInfo | undefined;
  #pictures: Uint8Array[] = []; // fetched files, kept in case the page needs another size or loses its graphics memory
  #turn = 0;
  #showing: Promise<void> | undefined;
  #isStale = false;
  readonly #shown = new Shown();
  #isRenumbered = false; // whether the decoder was reset to the base mesh since the last state was shown
  #isBehind = false; // whether the decoder's surface is still coarser than the surface shown
  #isStalled = false;

  constructor(
    private readonly source: Source,
    private readonly decoder: ModelDecoder,
    private readonly sink: Sink,
    /**
     * Aborted by close(). The caller of open() may already have started a request with the signal
     * of this controller.
     */
    private readonly life = new AbortController(),
    private readonly wait: RetryDelay = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds)),
  ) {}

  /**
   * Fetches the model's head. Resolves when the base mesh is displayed, with the pictures of the head.
   * Requests no enhancement layers. If `isRestart`, a finer surface is already displayed; it stays visible
   * until a detail request is reached.
   */
  async open(isRestart = false, asked = this.source.head(this.life.signal)): Promise<void> {
    const { signal } = this.life;
    let head = await asked;
    head = await this.#extend(head, this.decoder.headerLength(head));
    const info = (this.#info = this.decoder.open(head)), presentation = presentationOf(this.source.presentation);
    if (presentation) info.presentation = presentation;
    head = await this.#extend(head, this.#level(0).cumulativeBytes);
    const base = part(head, info.baseOffset, info.baseLength);
    this.decoder.checkBase(base);
    this.decoder.start(base, this.#atlas(head, info.texture));
    this.sink.opened(info);
    this.#pictures = picturesOf(head, info.texture);
    await Promise.all(this.#pictures.map((_, index) => this.showPicture(index)));
    signal.throwIfAborted();
    this.#isBehind = isRestart;
    this.#present();
    await this.#showing;
  }

  /**
   * Refines or coarsens to `want`. Resolves to true when `want` is reached and shown. Resolves to
   * false if a later request replaces it.
   */
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

  /**
   * Fetches a picture and displays it in a size of `side` by `side` pixels. By default, `side` is
   * the side of the picture in the file. Resolves when the picture is decoded. Fetched files are
   * kept, because another size may be needed later.
   */
  async showPicture(index: number, side?: number): Promise<void> {
    const picture = this.#info?.texture?.pictures[index];
    if (!picture) throw new ModelError(`the model has no picture ${index}`);
    const { offset, length, sha256 } = picture;
    const show = async () => {
      const bytes = this.#pictures[index] ?? (await this.source.getBytes({ offset, length, sha256 }, this.life.signal));
      this.#stall(undefined);
      this.decoder.checkPicture(index, bytes);
      this.#pictures[index] = bytes;
      await this.sink.picture(index, picture, side ?? picture.side, bytes);
      return true;
    };
    await this.#persist(show, () => undefined, () => !this.life.signal.aborted);
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

  /**
   * Returns the checked atlas (coded texture coordinates) of the base mesh. It is empty if the
   * model has no texture.
   */
  #atlas(head: Uint8Array, texture: TextureInfo | undefined): Uint8Array {
    if (!texture) return new Uint8Array();
    const atlas = part(head, texture.atlasOffset, texture.atlasLength);
    this.decoder.checkAtlas(atlas);
    return atlas;
  }

  /** Returns the chunks that the detail request still needs, in the planner's order. */
  #plan(): number[] {
    const plan = [];
    for (let chunk = this.decoder.nextChunk(); chunk !== undefined; chunk = this.decoder.nextChunk()) plan.push(chunk);
    return plan;
  }

  /** Returns the indices of the chunks that have been fetched, in ascending order. */
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

  /**
   * Aborts the requests for chunks that are not in `plan`. Keeps fetched chunks, because they can
   * be applied again.
   */
  #abandon(plan: number[]): void {
    const wanted = new Set(plan);
    for (const [chunk, { abort, isDone }] of this.#fetches) {
      if (isDone || wanted.has(chunk)) continue;
      this.#fetches.delete(chunk);
      abort.abort();
    }
  }

  /**
   * Fetches and applies a chunk. Resolves to false if a later detail request has replaced the
   * current one.
   */
  #apply(chunk: number, ask: () => void, isCurrent: () => boolean): Promise<boolean> {
    const apply = async () => {
      const bytes = await this.#fetch(chunk);
      if (!isCurrent()) return false;
      this.#stall(undefined);
      try {
        this.decoder.checkChunk(chunk, bytes);
        this.decoder.apply(chunk, bytes);
      } catch (error) {
        this.#fetches.delete(chunk);
        throw error;
      }
      return true;
    };
    return this.#persist(apply, ask, isCurrent);
  }

  /**
   * Returns the result of `attempt`. If its data are damaged, tries a second time. If the server
   * cannot be reached, retries until the server responds, and calls `ask` before each retry.
   * Resolves to false when the result is no longer needed.
   */
  async #persist(attempt: () => Promise<boolean>, ask: () => void, isCurrent: () => boolean): Promise<boolean> {
    for (let damaged = 0, lost = 0; ; ) {
      try {
        return await attempt();
      } catch (error) {
        if (!isCurrent()) return false;
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
   * Shows the decoder's current state. If an earlier state is still being displayed, first waits
   * until it is displayed. Does nothing while the decoder's state is coarser than the surface
   * shown.
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

/** Returns copies of the pictures of the head. */
function picturesOf(head: Uint8Array, texture: TextureInfo | undefined): Uint8Array[] {
  return texture?.pictures.slice(0, texture.inHead).map(({ offset, length }) => head.slice(offset, offset + length)) ?? [];
}

function part(bytes: Uint8Array, offset: number, length: number): Uint8Array {
  return bytes.subarray(offset, offset + length);
}

/** Yields to the event loop, so that pending messages are handled, such as a new detail request or close. */
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
