// SPDX-License-Identifier: Apache-2.0
// The web worker. For all models of a page, it fetches data, decodes it and plans which data to
// fetch next, so that the page stays responsive.
import type { Assets } from "./assets.ts";
import type { Piece } from "./change.ts";
import { Decoder } from "./decoder.ts";
import { RelayedResponse } from "./first-request.ts";
import { decodePicture } from "./picture-bands.ts";
import { Lending } from "./lending.ts";
import type { FromWorker, ToWorker } from "./messages.ts";
import { PolicyWatch } from "./policy.ts";
import { Session, type Sink } from "./session.ts";
import { openSource } from "./open-source.ts";
import { ModelError } from "./types.ts";

declare const self: EventTarget & {
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
};

type Address = Pick<Extract<ToWorker, { type: "open" }>, "url" | "transport" | "token">;

interface WorkerModel {
  session: Promise<Session>;
  /** Resolves when the base mesh is displayed. */
  opened: Promise<void>;
  /** The response to the first request, if the page has sent that request. */
  first: RelayedResponse | undefined;
  /** Buffers for the change that is being sent to the page. */
  lending: Lending;
  shown: () => void;
}

const models = new Map<number, WorkerModel>();
const policy = new PolicyWatch(self);
let wasm: Promise<WebAssembly.Module> | undefined;

self.onmessage = ({ data }) => {
  if (data.type === "open") open(data);
  else if (data.type === "first") models.get(data.id)?.first?.receive(data.part);
  else if (data.type === "refine") void refine(data);
  else if (data.type === "showPicture") void showPicture(data);
  else if (data.type === "taken") models.get(data.id)?.lending.giveBack(data.buffers);
  else if (data.type === "shown") models.get(data.id)?.shown();
  else close(data.id);
};

function open({ id, isRestart, isAsked, assets, ...address }: Extract<ToWorker, { type: "open" }>): void {
  const first = isAsked ? new RelayedResponse() : undefined;
  const session = create(id, address, assets, first?.response);
  const opened = session.then(({ session: created, head }) => created.open(isRestart, head));
  models.set(id, { session: session.then((created) => created.session), opened, first, lending: new Lending(), shown: () => undefined });
  opened
    .then(() => self.postMessage({ type: "ready", id }))
    .catch((error) => void fail(id, undefined, error));
}

/** Opens a model. Downloads the model's head and the decoder in parallel. `first` is the response to a request of the page. */
async function create(
  id: number, { url, transport, token }: Address, assets: Assets, first?: Promise<Response | undefined>,
): Promise<{ session: Session; head: Promise<Uint8Array> }> {
  const source = openSource(url, transport, token, first), life = new AbortController();
  const head = source.head(life.signal);
  wasm ??= compile(assets.wasm);
  // Errors are reported where the promises are awaited. After an error, the next model that is
  // opened loads the decoder again.
  head.catch(() => undefined);
  wasm.catch(() => (wasm = undefined));
  try {
    const decoder = await Decoder.create(await wasm);
    return { session: new Session(source, decoder, sink(id), life), head };
  } catch (error) {
    life.abort();
    source.close();
    throw error;
  }
}

function sink(id: number): Sink {
  return {
    opened: (info) => self.postMessage({ type: "opened", id, info }),
    picture: async (index, picture, side, bytes) => {
      const bands = await decodePicture(bytes, picture.side, side);
      self.postMessage({ type: "picture", id, index, bands }, bands);
    },
    progress: (progress) => self.postMessage({ type: "progress", id, progress }),
    stalled: (reason) => self.postMessage({ type: "stalled", id, reason }),
    show: async (change, pieces) => {
      const model = models.get(id);
      if (!model) return;
      model.lending = new Lending();
      const shown = new Promise<void>((resolve) => (model.shown = resolve));
      self.postMessage({ type: "change", id, change });
      if (await lend(id, pieces, model.lending)) await shown;
    },
  };
}

/** Sends the pieces to the page whenever a buffer is free. Resolves to false if the model was closed meanwhile. */
async function lend(id: number, pieces: Piece[], lending: Lending): Promise<boolean> {
  for (const { part, first, count, write } of pieces) {
    const buffer = await lending.borrow();
    if (!buffer) return false;
    write(buffer);
    self.postMessage({ type: "block", id, block: { part, first, count, buffer } }, [buffer]);
  }
  return true;
}

async function refine({ id, turn, want }: Extract<ToWorker, { type: "refine" }>): Promise<void> {
  try {
    const model = models.get(id);
    await model?.opened;
    const isReached = (await (await model?.session)?.refine(want)) ?? false;
    self.postMessage({ type: "settled", id, turn, isReached });
  } catch (error) {
    void fail(id, turn, error);
  }
}

/**
 * Shows a picture. If the picture cannot be fetched, sends an empty list of bands. The page then keeps the
 * picture that it shows.
 */
async function showPicture({ id, index, side }: Extract<ToWorker, { type: "showPicture" }>): Promise<void> {
  try {
    const model = models.get(id);
    await model?.opened;
    await (await model?.session)?.showPicture(index, side);
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) return void fail(id, undefined, error);
    self.postMessage({ type: "picture", id, index, bands: [] });
  }
}

function close(id: number): void {
  const model = models.get(id);
  models.delete(id);
  model?.lending.close();
  model?.shown();
  model?.session.then((session) => session.close()).catch(() => undefined);
}

async function fail(id: number, turn: number | undefined, error: unknown): Promise<void> {
  if (!models.has(id)) return;
  if (error instanceof WebAssembly.RuntimeError) {
    close(id);
    return self.postMessage({ type: "stopped", id });
  }
  const message = error instanceof ModelError ? error.message : `the model cannot be shown: ${(error as Error).message}`;
  const forbidden = await policy.reason();
  self.postMessage({ type: "failed", id, turn, message: forbidden ?? message });
}

async function compile(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new ModelError(`the decoder is not there (${response.status}): ${url}`);
  const bytes = await response.arrayBuffer();
  // Some servers send an HTML page if they do not have the requested file.
  if (!isWasm(bytes)) throw new ModelError(`the decoder is not there (no WebAssembly): ${url}`);
  return WebAssembly.compile(bytes);
}

function isWasm(bytes: ArrayBuffer): boolean {
  return bytes.byteLength > 4 && new DataView(bytes).getUint32(0) === 0x0061736d; // "\0asm"
}
