// SPDX-License-Identifier: Apache-2.0
// The messages between page and worker. `id` identifies a model, `turn` a detail request. `isAsked` says that the page has
// sent the first request for the model, and passes the response on in "first" messages.
import type { Assets } from "./assets.ts";
import type { ResponsePart } from "./first-request.ts";
import type { Transport } from "./source.ts";
import type { Block, Change, ModelInfo, Progress, Want } from "./types.ts";

export type ToWorker =
  | { type: "open"; id: number; url: string; transport: Transport; token: string; assets: Assets; isRestart: boolean; isAsked: boolean }
  | { type: "first"; id: number; part: ResponsePart }
  | { type: "refine"; id: number; turn: number; want: Want }
  | { type: "showPicture"; id: number; index: number; side: number }
  | { type: "taken"; id: number; buffers: ArrayBuffer[] }
  | { type: "shown"; id: number }
  | { type: "close"; id: number };

export type FromWorker =
  | { type: "opened"; id: number; info: ModelInfo }
  | { type: "change"; id: number; change: Change }
  | { type: "block"; id: number; block: Block }
  | { type: "picture"; id: number; index: number; bands: ImageBitmap[] }
  | { type: "stalled"; id: number; reason: string | undefined }
  | { type: "progress"; id: number; progress: Progress }
  | { type: "ready"; id: number }
  | { type: "stopped"; id: number }
  | { type: "settled"; id: number; turn: number; isReached: boolean }
  | { type: "failed"; id: number; turn: number | undefined; message: string };
