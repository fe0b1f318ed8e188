// SPDX-License-Identifier: Apache-2.0
// The page's interface to the worker. All models of a page share one worker, which is terminated when
// the last model is closed.
import workerText from "./worker.ts?text";
import { Budget, type ModelSize } from "./budget.ts";
import type { Assets, FromWorker, ToWorker } from "./messages.ts";
import type { Transport } from "./source.ts";
import { ModelError, type Block, type Change, type ModelInfo, type Progress, type Want } from "./types.ts";

export interface ModelListener {
  opened(info: ModelInfo): void;
  /**
   * Called before the blocks of a change arrive. Call `shown` when the change is displayed; only then does the next
   * one arrive.
   */
  change(change: Change, shown: () => void): void;
  /** Called for each block of the announced change. Return the block's buffer with `giveBack`. */
  block(block: Block): void;
  progress(progress: Progress): void;
  /** Called with the reason when the server does not respond, and with undefined when it responds again. */
  stalled(reason: string | undefined): void;
  failed(error: ModelError): void;
}

interface Turn {
  want: Want;
  resolve(isReached: boolean): void;
  reject(error: ModelError): void;
}

const budget = new Budget();

/** Sets the maximum that all models of the page may use together when refined for a camera (ProgressiveMesh.refineFor). */
export function setBudget(most: ModelSize): void {
  budget.most = most;
}

const models = new Map<number, RemoteModel>();
let worker: Worker | undefined;
let lastId = 0;

/** Returns the URLs of the viewer's files in the folder of the module at `moduleUrl`. */
export function assetsBeside(moduleUrl: string): Assets {
  const beside = (name: string) => new URL(name, moduleUrl).href;
  return {
    wasm: beside("progressive-mesh.wasm"),
    dracoScript: beside("draco_decoder.js"),
    dracoWasm: beside("draco_decoder.wasm"),
  };
}

/** A model whose session runs in the worker. It opens immediately; its messages are queued until a listener is set. */
export class RemoteModel {
  readonly #id = ++lastId;
  readonly #url: string;
  readonly #turns = new Map<number, Turn>();
  #turn = 0;
  #last: Want | undefined;
  #isReady = false;
  #stops = 0; // number of decoder failures since a detail request was last reached
  #lost: ModelError | undefined;
  #listener: ModelListener | undefined;
  #unheard: ((listener: ModelListener) => void)[] = [];

  constructor(
    url: string,
    private readonly transport: Transport,
    private readonly assets: Assets,
    private readonly token = "",
  ) {
    this.#url = new URL(url, document.baseURI).href;
    models.set(this.#id, this);
    this.#open(false);
  }

  set listener(listener: ModelListener) {
    this.#listener = listener;
    for (const tell of this.#unheard.splice(0)) tell(listener);
  }

  #tell(tell: (listener: ModelListener) => void): void {
    if (this.#listener) tell(this.#listener);
    else this.#unheard.push(tell);
  }

  /** Resolves to true when `want` is reached and shown, to false if it is superseded or the model is closed. */
  refine(want: Want): Promise<boolean> {
    if (this.#lost) return Promise.reject(this.#lost);
    const turn = ++this.#turn;
    this.#last = want;
    return new Promise((resolve, reject) => {
      this.#turns.set(turn, { want, resolve, reject });
      this.#ask(turn, want);
    });
  }

  close(): void {
    if (!models.delete(this.#id)) return;
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
    else if (message.type === "change") this.#show(message.change);
    else if (message.type === "settled") this.#reach(message.turn, message.isReached);
    else if (message.type === "failed") this.#fail(message.turn, new ModelError(message.message));
    else this.stop("a fault in the model");
  }

  /**
   * Handles a stopped decoder. A model that is already shown gets a new decoder; its current surface stays visible
   * until the new decoder has reached the detail request. The model fails if it was not shown yet, or if the new
   * decoder stops before it has reached the request.
   */
  stop(reason: string | undefined): void {
    if (this.#isReady && ++this.#stops === 1) return this.#restart();
    this.#lost = new ModelError(`the viewer's decoder stopped${reason ? ` (${reason})` : ""}: reload the page`);
    models.delete(this.#id);
    budget.release(this);
    for (const turn of this.#turns.values()) turn.reject(this.#lost);
    this.#turns.clear();
    const lost = this.#lost;
    this.#tell((listener) => listener.failed(lost));
  }

  #open(isRestart: boolean): void {
    const { transport, assets, token } = this;
    send({ type: "open", id: this.#id, url: this.#url, transport, token, assets, isRestart });
  }

  #restart(): void {
    this.#open(true);
    if (!this.#turns.has(this.#turn) && this.#last) this.refine(this.#last).catch(() => undefined); // the listener receives the error
    else for (const [turn, { want }] of this.#turns) this.#ask(turn, want);
  }

  #ask(turn: number, want: Want): void {
    const most = budget.room(this);
    const limited = "view" in want ? { view: { ...most, ...want.view } } : want;
    send({ type: "refine", id: this.#id, turn, want: limited });
  }

  #show(change: Change): void {
    budget.hold(this, { triangles: change.triangles, bytes: change.bytes });
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
    if (turn !== undefined) this.#settle(turn)?.reject(error);
    this.#tell((listener) => listener.failed(error));
  }
}

function send(message: ToWorker): void {
  worker ??= startWorker();
  worker.postMessage(message);
}

/** Starts the worker from a blob, because a worker script must have the same origin as the embedding page. */
function startWorker(): Worker {
  const url = URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
  const started = new Worker(url);
  URL.revokeObjectURL(url);
  started.onmessage = ({ data }: MessageEvent<FromWorker>) => models.get(data.id)?.receive(data);
  started.onerror = (event) => {
    event.preventDefault(); // the models report the error
    if (started === worker) stop(event.message);
  };
  return started;
}

/**
 * Ends the worker and reports the stop to all models. Called when the worker cannot start, for example because the
 * page's security policy forbids it, or has crashed, for example for lack of memory.
 */
function stop(reason: string | undefined): void {
  worker?.terminate();
  worker = undefined;
  for (const model of [...models.values()]) model.stop(reason);
}
