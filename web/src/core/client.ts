// SPDX-License-Identifier: Apache-2.0
// The page's interface to the worker. All models of a page share one worker. The worker is
// terminated when the last model is closed.
import type { Assets } from "./assets.ts";
import { Budget, type ModelSize } from "./budget.ts";
import { firstRequest, relay } from "./first-request.ts";
import type { FromWorker, ToWorker } from "./messages.ts";
import { PolicyWatch } from "./policy.ts";
import type { Transport } from "./source.ts";
import { ModelError, type Block, type Change, type ModelInfo, type Progress, type Want } from "./types.ts";
import { workerUrl } from "./worker-url.ts";

export interface ModelListener {
  opened(info: ModelInfo): void;
  /**
   * Called before the blocks of a change arrive. Call `shown` when the change is displayed. The
   * next change arrives only after that.
   */
  change(change: Change, shown: () => void): void;
  /** Called for each block of the announced change. Return the buffer of the block with `giveBack`. */
  block(block: Block): void;
  /**
   * Called for each picture that has been decoded. `bands` are its parts from top to bottom. The list is empty if the
   * picture cannot be shown. The listener closes the bands.
   */
  picture(index: number, bands: ImageBitmap[]): void;
  progress(progress: Progress): void;
  /** Called with a reason when the server stops responding, and with undefined when it responds again. */
  stalled(reason: string | undefined): void;
  failed(error: ModelError): void;
}

interface Turn {
  want: Want;
  resolve(isReached: boolean): void;
  reject(error: ModelError): void;
}

const budget = new Budget();

/**
 * Sets limits for all models of the page together. `triangles` and `bytes` limit models that are
 * refined for a camera (ProgressiveMesh.refineFor). `texels` limits the models' pictures.
 */
export function setBudget(most: ModelSize): void {
  budget.most = { texels: Infinity, ...most };
}

const models = new Map<number, RemoteModel>();
let worker: Worker | undefined;
let policy: PolicyWatch | undefined;
let lastId = 0;

/**
 * A model whose session runs in the worker. The constructor opens the model. Messages are queued
 * until a listener is set.
 */
export class RemoteModel {
  readonly #id = ++lastId;
  readonly #url: string;
  readonly #turns = new Map<number, Turn>();
  #turn = 0;
  #last: Want | undefined;
  #isReady = false;
  #stops = 0; // number of decoder failures since the last detail request was reached
  #held: Required<ModelSize> = { triangles: 0, bytes: 0, texels: 0 };
  #lost: ModelError | undefined;
  #listener: ModelListener | undefined;
  #unheard: ((listener: ModelListener) => void)[] = [];
  readonly #relay = new AbortController(); // stops forwarding the response to the first request

  constructor(
    url: string,
    private readonly transport: Transport,
    private readonly assets: Assets,
    private readonly token = "",
  ) {
    this.#url = new URL(url, document.baseURI).href;
    models.set(this.#id, this);
    this.#open(false, this.#askFirst());
  }

  set listener(listener: ModelListener) {
    this.#listener = listener;
    for (const tell of this.#unheard.splice(0)) tell(listener);
  }

  #tell(tell: (listener: ModelListener) => void): void {
    if (this.#listener) tell(this.#listener);
    else this.#unheard.push(tell);
  }

  /**
   * Resolves to true when `want` is reached and shown. Resolves to false if another request
   * replaces `want` or the model is closed.
   */
  refine(want: Want): Promise<boolean> {
    if (this.#lost) return Promise.reject(this.#lost);
    const turn = ++this.#turn;
    this.#last = want;
    return new Promise((resolve, reject) => {
      this.#turns.set(turn, { want, resolve, reject });
      this.#ask(turn, want);
    });
  }

  /**
   * Requests a picture of the model's texture, in a size of `side` by `side` pixels. The picture arrives at the
   * listener.
   */
  showPicture({ index, side }: { index: number; side: number }): void {
    if (models.has(this.#id)) send({ type: "showPicture", id: this.#id, index, side });
  }

  /** Number of texels that the pictures of this model may use now. */
  get roomForTexels(): number {
    return budget.room(this).texels;
  }

  /** Records the number of texels that the pictures of this model use. */
  holdTexels(texels: number): void {
    this.#held.texels = texels;
    if (models.has(this.#id)) budget.hold(this, this.#held);
  }

  close(): void {
    if (!models.delete(this.#id)) return;
    this.#relay.abort();
    budget.release(this);
    for (const turn of this.#turns.values()) turn.resolve(false);
    send({ type: "close", id: this.#id });
    if (models.size === 0) {
      worker?.terminate();
      worker = undefined;
    }
  }

  /** Returns the buffers of received blocks to the worker. */
  giveBack(buffers: ArrayBuffer[]): void {
    if (models.has(this.#id)) worker?.postMessage({ type: "taken", id: this.#id, buffers } satisfies ToWorker, buffers);
  }

  receive(message: FromWorker): void {
    if (message.type === "opened") this.#tell((listener) => listener.opened(message.info));
    else if (message.type === "ready") this.#isReady = true;
    else if (message.type === "progress") this.#tell((listener) => listener.progress(message.progress));
    else if (message.type === "stalled") this.#tell((listener) => listener.stalled(message.reason));
    else if (message.type === "block") this.#tell((listener) => listener.block(message.block));
    else if (message.type === "picture") this.#tell((listener) => listener.picture(message.index, message.bands));
    else if (message.type === "change") this.#show(message.change);
    else if (message.type === "settled") this.#reach(message.turn, message.isReached);
    else if (message.type === "failed") this.#fail(message.turn, new ModelError(message.message));
    else this.stop(stopped("a fault in the model"));
  }

  /**
   * Handles a decoder that has stopped. If the model is already shown, it gets a new decoder, and
   * its surface stays visible until the new decoder has reached the detail request. If the model
   * was not shown yet, or the new decoder stops before it has reached the request, the model fails.
   */
  stop(message: string): void {
    this.#relay.abort();
    if (this.#isReady && ++this.#stops === 1) return this.#restart();
    this.#lost = new ModelError(message);
    models.delete(this.#id);
    budget.release(this);
    for (const turn of this.#turns.values()) turn.reject(this.#lost);
    this.#turns.clear();
    const lost = this.#lost;
    this.#tell((listener) => listener.failed(lost));
  }

  #open(isRestart: boolean, isAsked: boolean): void {
    const { transport, assets, token } = this;
    worker ??= startWorker(assets);
    send({ type: "open", id: this.#id, url: this.#url, transport, token, assets, isRestart, isAsked });
  }

  /** Sends the first request for the model, unless the worker must send it. Returns whether the page has sent it. */
  #askFirst(): boolean {
    const request = firstRequest(this.#url, this.transport, this.token), id = this.#id;
    if (!request) return false;
    void relay(request, this.#relay.signal, (part) => (
      worker?.postMessage({ type: "first", id, part } satisfies ToWorker, part instanceof Uint8Array ? [part.buffer] : [])));
    return true;
  }

  #restart(): void {
    this.#open(true, false);
    if (!this.#turns.has(this.#turn) && this.#last) this.refine(this.#last).catch(() => undefined); // the listener receives the error
    else for (const [turn, { want }] of this.#turns) this.#ask(turn, want);
  }

  #ask(turn: number, want: Want): void {
    const { triangles, bytes } = budget.room(this);
    const limited = "view" in want ? { view: { triangles, bytes, ...want.view } } : want;
    send({ type: "refine", id: this.#id, turn, want: limited });
  }

  #show(change: Change): void {
    this.#held = { ...this.#held, triangles: change.triangles, bytes: change.bytes };
    budget.hold(this, this.#held);
    const shown = () => models.has(this.#id) && send({ type: "shown", id: this.#id });
    this.#tell((listener) => listener.change(change, shown));
  }

  #settle(turn: number): Turn | undefined {
    const found = this.#turns.get(turn);
    this.#turns.delete(turn);
    return found;
  }

  #reach(turn: number, isReached: boolean): void {
    if (isReached) this.#stops = 0;
    this.#settle(turn)?.resolve(isReached);
  }

  #fail(turn: number | undefined, error: ModelError): void {
    if (turn === undefined) this.#relay.abort(); // the model cannot be opened
    else this.#settle(turn)?.reject(error);
    this.#tell((listener) => listener.failed(error));
  }
}

function send(message: ToWorker): void {
  worker?.postMessage(message);
}

function stopped(reason: string | undefined): string {
  return `the viewer's decoder stopped${reason ? ` (${reason})` : ""}: reload the page`;
}

function startWorker(assets: Assets): Worker {
  const url = workerUrl(assets);
  policy ??= new PolicyWatch(document, ["worker-src"]);
  const started = new Worker(url);
  URL.revokeObjectURL(url);
  let hasStarted = false;
  started.onmessage = ({ data }: MessageEvent<FromWorker>) => {
    hasStarted = true;
    models.get(data.id)?.receive(data);
  };
  started.onerror = async (event) => {
    event.preventDefault(); // the models report the error
    const isMissing = !hasStarted && !url.startsWith("blob:");
    const message = isMissing ? `the viewer's worker is not there: ${url}; see "Bundlers" in the README of @vitrine/progressive-mesh` : stopped(event.message);
    const forbidden = await policy?.reason();
    if (started === worker) stop(forbidden ?? message);
  };
  return started;
}

/**
 * Ends the worker and tells all models that it has stopped. Called if the worker cannot start or
 * has crashed. For example, the page's security policy may forbid workers, or memory may run out.
 */
function stop(message: string): void {
  worker?.terminate();
  worker = undefined;
  for (const model of [...models.values()]) model.stop(message);
}
