// SPDX-License-Identifier: Apache-2.0
// The worker: fetches, decodes and plans for all models of a page, so that the page stays responsive.
import type { Piece } from "./change.ts";
import { Decoder } from "./decoder.ts";
import { decodeBase, type DracoModule } from "./draco.ts";
import { Lending } from "./lending.ts";
import type { Assets, FromWorker, ToWorker } from "./messages.ts";
import { Session, type Sink } from "./session.ts";
import { openSource } from "./open-source.ts";
import { readAll } from "./source.ts";
import { ModelError } from "./types.ts";

declare const self: {
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
};
declare function importScripts(url: string): void;
declare const DracoDecoderModule: (options: { wasmBinary: Uint8Array }) => Promise<DracoModule>;

type Address = Pick<Extract<ToWorker, { type: "open" }>, "url" | "transport" | "token">;

interface WorkerModel {
  session: Promise<Session>;
  /** Resolves when the base mesh is displayed. */
  opened: Promise<void>;
  /** Buffers for the change that is being sent to the page. */
  lending: Lending;
  shown: () => void;
}

const models = new Map<number, WorkerModel>();
let wasm: Promise<WebAssembly.Module> | undefined;
let draco: Promise<DracoModule> | undefined;

self.onmessage = ({ data }) => {
  if (data.type === "open") open(data);
  else if (data.type === "refine") void refine(data);
  else if (data.type === "taken") models.get(data.id)?.lending.giveBack(data.buffers);
  else if (data.type === "shown") models.get(data.id)?.shown();
  else close(data.id);
};

function open({ id, isRestart, assets, ...address }: Extract<ToWorker, { type: "open" }>): void {
  const session = create(id, address, assets);
  const opened = session.then(({ session: created, head }) => created.open(isRestart, head));
  models.set(id, { session: session.then((created) => created.session), opened, lending: new Lending(), shown: () => undefined });
  opened
    .then(() => self.postMessage({ type: "ready", id }))
    .catch((error) => fail(id, undefined, error));
}

/** Starts all downloads in parallel: the model's head does not wait for the decoders. */
async function create(id: number, { url, transport, token }: Address, assets: Assets): Promise<{ session: Session; head: Promise<Uint8Array> }> {
  const source = openSource(url, transport, token), life = new AbortController();
  const head = source.head(life.signal);
  wasm ??= compile(assets.wasm);
  draco ??= loadDraco(assets);
  // Failures are reported where the promises are awaited. The next model that is opened loads the files again.
  head.catch(() => undefined);
  wasm.catch(() => (wasm = undefined));
  draco.catch(() => (draco = undefined));
  const loaded = draco;
  try {
    const decoder = await Decoder.create(await wasm);
    return { session: new Session(source, decoder, async (bytes, info) => decodeBase(await loaded, bytes, info), sink(id), life), head };
  } catch (error) {
    life.abort();
    source.close();
    throw error;
  }
}

function sink(id: number): Sink {
  return {
    opened: (info) => self.postMessage({ type: "opened", id, info }),
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

/** Sends the pieces as fast as buffers are returned. Resolves to false if the model was closed meanwhile. */
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
    fail(id, turn, error);
  }
}

function close(id: number): void {
  const model = models.get(id);
  models.delete(id);
  model?.lending.close();
  model?.shown();
  model?.session.then((session) => session.close()).catch(() => undefined);
}

function fail(id: number, turn: number | undefined, error: unknown): void {
  if (!models.has(id)) return;
  if (error instanceof WebAssembly.RuntimeError) {
    close(id);
    return self.postMessage({ type: "stopped", id });
  }
  const message = error instanceof ModelError ? error.message : `the model cannot be shown: ${(error as Error).message}`;
  self.postMessage({ type: "failed", id, turn, message });
}

async function compile(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new ModelError(`the decoder is not there (${response.status}): ${url}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

async function loadDraco(assets: Assets): Promise<DracoModule> {
  const binary = fetch(assets.dracoWasm).then((response) => readAll(response, "the decoder of base meshes"));
  binary.catch(() => undefined); // a failure is reported below, unless the script fails first
  importScripts(assets.dracoScript);
  return DracoDecoderModule({ wasmBinary: await binary });
}
