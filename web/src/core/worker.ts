// SPDX-License-Identifier: Apache-2.0
// The worker: fetches, decodes and plans for every model of a page, so that the page never waits.
import { Decoder } from "./decoder.ts";
import { decodeBase, type DracoModule } from "./draco.ts";
import type { Assets, FromWorker, ToWorker } from "./messages.ts";
import { Session, type Sink } from "./session.ts";
import { openSource, type Source } from "./source.ts";
import { ModelError, type Surface } from "./types.ts";

declare const self: {
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
};
declare function importScripts(url: string): void;
declare const DracoDecoderModule: (options: { locateFile: () => string }) => Promise<DracoModule>;

interface Model {
  session: Promise<Session>;
  shown: () => void;
}

const models = new Map<number, Model>();
let wasm: Promise<WebAssembly.Module> | undefined;
let draco: Promise<DracoModule> | undefined;

self.onmessage = ({ data }) => {
  if (data.type === "open") open(data);
  else if (data.type === "refine") void refine(data);
  else if (data.type === "shown") models.get(data.id)?.shown();
  else close(data.id);
};

function open({ id, url, transport, assets }: Extract<ToWorker, { type: "open" }>): void {
  const model: Model = { session: create(id, () => openSource(url, transport), assets), shown: () => undefined };
  models.set(id, model);
  model.session
    .then((session) => session.open())
    .then(() => self.postMessage({ type: "ready", id }))
    .catch((error) => fail(id, undefined, error));
}

async function create(id: number, source: () => Source, assets: Assets): Promise<Session> {
  wasm ??= compile(assets.wasm);
  draco ??= loadDraco(assets);
  // Failures are reported where they are waited for; the next model tries again.
  wasm.catch(() => (wasm = undefined));
  draco.catch(() => (draco = undefined));
  const loaded = draco;
  const decoder = await Decoder.create(await wasm);
  return new Session(source(), decoder, async (bytes, level) => decodeBase(await loaded, bytes, level), sink(id));
}

function sink(id: number): Sink {
  return {
    opened: (info) => self.postMessage({ type: "opened", id, info }),
    progress: (progress) => self.postMessage({ type: "progress", id, progress }),
    show: (surface) =>
      new Promise((resolve) => {
        const model = models.get(id);
        if (!model) return resolve();
        model.shown = resolve;
        self.postMessage({ type: "surface", id, surface }, buffers(surface));
      }),
  };
}

async function refine({ id, turn, want }: Extract<ToWorker, { type: "refine" }>): Promise<void> {
  try {
    const session = await models.get(id)?.session;
    const reached = (await session?.refine(want)) ?? false;
    self.postMessage({ type: "settled", id, turn, reached });
  } catch (error) {
    fail(id, turn, error);
  }
}

function close(id: number): void {
  const model = models.get(id);
  models.delete(id);
  model?.shown();
  model?.session.then((session) => session.close()).catch(() => undefined);
}

function fail(id: number, turn: number | undefined, error: unknown): void {
  if (!models.has(id)) return;
  const message =
    error instanceof ModelError ? error.message
    : error instanceof WebAssembly.RuntimeError ? "the decoder stopped on this model: reload the page"
    : `the model cannot be shown: ${(error as Error).message}`;
  self.postMessage({ type: "failed", id, turn, message });
}

async function compile(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new ModelError(`the decoder is not there (${response.status}): ${url}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

async function loadDraco(assets: Assets): Promise<DracoModule> {
  importScripts(assets.dracoScript);
  return DracoDecoderModule({ locateFile: () => assets.dracoWasm });
}

function buffers(surface: Surface): Transferable[] {
  const arrays = [surface.positions, surface.normals, surface.indices, surface.colours];
  return arrays.flatMap((array) => (array ? [array.buffer as ArrayBuffer] : []));
}
