// SPDX-License-Identifier: Apache-2.0
// What the page and the worker say to each other. `id` names a model, `turn` a want.
import type { Transport } from "./source.ts";
import type { Block, Change, ModelInfo, Progress, Want } from "./types.ts";

/** Absolute URLs of what the worker loads. */
export interface Assets {
  wasm: string;
  dracoScript: string;
  dracoWasm: string;
}

export type ToWorker =
  | { type: "open"; id: number; url: string; transport: Transport; token: string; assets: Assets; again: boolean }
  | { type: "refine"; id: number; turn: number; want: Want }
  | { type: "taken"; id: number; buffers: ArrayBuffer[] }
  | { type: "shown"; id: number }
  | { type: "close"; id: number };

export type FromWorker =
  | { type: "opened"; id: number; info: ModelInfo }
  | { type: "change"; id: number; change: Change }
  | { type: "block"; id: number; block: Block }
  | { type: "stalled"; id: number; reason: string | undefined }
  | { type: "progress"; id: number; progress: Progress }
  | { type: "ready"; id: number }
  | { type: "stopped"; id: number }
  | { type: "settled"; id: number; turn: number; reached: boolean }
  | { type: "failed"; id: number; turn: number | undefined; message: string };
