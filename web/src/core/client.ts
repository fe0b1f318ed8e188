// SPDX-License-Identifier: Apache-2.0
// The page's side of the worker. All models of a page share one worker; it ends with the last.
import workerText from "./worker.ts?text";
import { Budget, type Amount } from "./budget.ts";
import type { Assets, FromWorker, ToWorker } from "./messages.ts";
import type { Transport } from "./source.ts";
import { ModelError, type Block, type Change, type ModelInfo, type Progress, type Want } from "./types.ts";

export interface ModelListener {
  opened(info: ModelInfo): void;
  /** Its blocks follow. Call `shown` once it is on display: the next one comes after that. */
  change(change: Change, shown: () => void): void;
  /** Give its buffer back. */
  block(block: Block): void;
  progress(progress: Progress): void;
  /** The server does not answer, and why; undefined once it does again. */
  stalled(reason: string | undefined): void;
  failed(error: ModelError): void;
}

interface Turn {
  want: Want;
  resolve(reached: boolean): void;
  reject(error: ModelError): void;
}

const budget = new Budget();

/** The most that all models of the page may hold together of what their cameras see (ProgressiveMesh.refineFor). */
export function setBudget(most: Amount): void {
  budget.most = most;
}

const models = new Map<number, RemoteModel>();
let worker: Worker | undefined;
let lastId = 0;

/** The files of the viewer that lie beside the module at `moduleUrl`. */
export function assetsBeside(moduleUrl: string): Assets {
  const beside = (name: string) => new URL(name, moduleUrl).href;
  return {
    wasm: beside("progressive-mesh.wasm"),
    dracoScript: beside("draco_decoder.js"),
    dracoWasm: beside("draco_decoder.wasm"),
  };
}

/** A model whose session lives in the worker, which starts at once; what it says waits for its listener. */
export class RemoteModel {
  readonly #id = ++lastId;
  readonly #url: string;
  readonly #turns = new Map<number, Turn>();
  #turn = 0;
  #last: Want | undefined;
  #ready = false;
  #stops = 0; // of its decoder, since it last reached what was wanted
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

  /** Resolves with true when `want` is reached and shown, with false when superseded or closed. */
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

  /** Buffers of blocks. */
  giveBack(buffers: ArrayBuffer[]): void {
    if (models.has(this.#id)) worker?.postMessage({ type: "taken", id: this.#id, buffers } satisfies ToWorker, buffers);
  }

  receive(message: FromWorker): void {
    if (message.type === "opened") this.#tell((listener) => listener.opened(message.info));
    else if (message.type === "ready") this.#ready = true;
    else if (message.type === "progress") this.#tell((listener) => listener.progress(message.progress));
    else if (message.type === "stalled") this.#tell((listener) => listener.stalled(message.reason));
    else if (message.type === "block") this.#tell((listener) => listener.block(message.block));
    else if (message.type === "change") this.#show(message.change);
    else if (message.type === "settled") this.#reach(message.turn, message.reached);
    else if (message.type === "failed") this.#fail(message.turn, new ModelError(message.message));
    else this.stop("a fault in the model");
  }

  /** Its decoder has stopped. Once it has shown something, it gets a new one, and what it shows stays until that is as far. */
  stop(reason: string | undefined): void {
    if (this.#ready && ++this.#stops === 1) return this.#restart();
    this.#lost = new ModelError(`the viewer's decoder stopped${reason ? ` (${reason})` : ""}: reload the page`);
    models.delete(this.#id);
    budget.release(this);
    for (const turn of this.#turns.values()) turn.reject(this.#lost);
    this.#turns.clear();
    const lost = this.#lost;
    this.#tell((listener) => listener.failed(lost));
  }

  #open(again: boolean): void {
    const { transport, assets, token } = this;
    send({ type: "open", id: this.#id, url: this.#url, transport, token, assets, again });
  }

  #restart(): void {
    this.#open(true);
    if (!this.#turns.has(this.#turn) && this.#last) this.refine(this.#last).catch(() => undefined); // the listener is told
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

  #reach(turn: number, reached: boolean): void {
    if (reached) this.#stops = 0;
    this.#settle(turn)?.resolve(reached);
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

/** From a blob, because a worker's script must have the origin of the page that embeds it. */
function startWorker(): Worker {
  const url = URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
  const started = new Worker(url);
  URL.revokeObjectURL(url);
  started.onmessage = ({ data }: MessageEvent<FromWorker>) => models.get(data.id)?.receive(data);
  started.onerror = (event) => {
    event.preventDefault(); // the models tell
    if (started === worker) stop(event.message);
  };
  return started;
}

/** The worker cannot start (the page's security policy forbids it) or has stopped (out of memory). */
function stop(reason: string | undefined): void {
  worker?.terminate();
  worker = undefined;
  for (const model of [...models.values()]) model.stop(reason);
}
