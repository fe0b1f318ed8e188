// SPDX-License-Identifier: Apache-2.0
// The interfaces between the viewer and its tools.
import type { Stage } from "../stage.ts";
import type { ViewerTexts } from "../../texts/index.ts";
import type { OrbitController } from "./orbit.ts";
import type { Overlay } from "./overlay.ts";

/** Restores the view and the level of detail that the page's attributes define. */
export interface ViewerDefaults {
  frame(): void;
  sharpen(): void;
}

export interface Bench {
  readonly host: HTMLElement & { token: string };
  /** The container of the canvas. */
  readonly view: HTMLElement;
  readonly texts: ViewerTexts;
  readonly overlay: Overlay;
  readonly orbit: OrbitController;
  /** The stage of a model whose base mesh is shown; available between attach() and detach(). */
  readonly stage: Stage;
  readonly page: ViewerDefaults;
  /** Number of triangles shown now. */
  readonly triangles: number;
  /** Announces a text to screen readers. */
  say(text: string): void;
}

export interface Tool {
  /** Called when a model is on the stage. Listeners and timers must end when `until` is aborted. */
  attach?(until: AbortSignal): void;
  /** Restores the initial settings. */
  reset?(): void;
}
