// SPDX-License-Identifier: Apache-2.0
// The page's side of the worker. All models of a page share one worker; it ends with the last.
import workerText from "./worker.ts?text";
import type { Assets, FromWorker, ToWorker } from "./messages.ts";
import type { Transport } from "./source.ts";
import { ModelError, type ModelInfo, type Progress, type Surface, type Want } from "./types.ts";

export interface ModelListener {
  opened(info: ModelInfo): void;
  /** Call `shown` once the surface is on display: the next one comes after that. */
  surface(surface: Surface, shown: () => void): void;
  progress(progress: Progress): void;
  failed(error: ModelError): void;
}

interface Turn {
  resolve(reached: boolean): void;
  reject(error: ModelError): void;
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

/** A model whose session lives in the worker. */
export class RemoteModel {
  readonly #id = ++lastId;
  readonly #turns = new Map<number, Turn>();
  #turn = 0;
  #lost: ModelError | undefined;

  constructor(
    url: string,
    transport: Transport,
    assets: Assets,
    private readonly listener: ModelListener,
  ) {
    models.set(this.#id, this);
    send({ type: "open", id: this.#id, url: new URL(url, document.baseURI).href, transport, assets });
  }

  /** Resolves with true when `want` is reached and shown, with false when superseded or closed. */
  refine(want: Want): Promise<boolean> {
    if (this.#lost) return Promise.reject(this.#lost);
    const turn = ++this.#turn;
    return new Promise((resolve, reject) => {
      this.#turns.set(turn, { resolve, reject });
      send({ type: "refine", id: this.#id, turn, want });
    });
  }

  close(): void {
    if (!models.delete(this.#id)) return;
    for (const turn of this.#turns.values()) turn.resolve(false);
    send({ type: "close", id: this.#id });
    if (models.size === 0) {
      worker?.terminate();
      worker = undefined;
    }
  }

  receive(message: FromWorker): void {
    if (message.type === "opened") this.listener.opened(message.info);
    else if (message.type === "progress") this.listener.progress(message.progress);
    else if (message.type === "surface") {
      this.listener.surface(message.surface, () => models.has(this.#id) && send({ type: "shown", id: this.#id }));
    } else if (message.type === "settled") this.#settle(message.turn)?.resolve(message.reached);
    else if (message.type === "failed") this.#fail(message.turn, new ModelError(message.message));
  }

  /** The session is gone with its worker. */
  lose(error: ModelError): void {
    this.#lost = error;
    for (const turn of this.#turns.values()) turn.reject(error);
    this.#turns.clear();
    this.listener.failed(error);
  }

  #settle(turn: number): Turn | undefined {
    const found = this.#turns.get(turn);
    this.#turns.delete(turn);
    return found;
  }

  #fail(turn: number | undefined, error: ModelError): void {
    if (turn !== undefined) this.#settle(turn)?.reject(error);
    this.listener.failed(error);
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
    if (started === worker) lose(event.message);
  };
  return started;
}

/** The worker cannot start (the page's security policy forbids it) or has stopped (out of memory). */
function lose(reason: string | undefined): void {
  worker?.terminate();
  worker = undefined;
  const error = new ModelError(`the viewer's decoder stopped${reason ? ` (${reason})` : ""}: reload the page`);
  const lost = [...models.values()];
  models.clear();
  for (const model of lost) model.lose(error);
}
