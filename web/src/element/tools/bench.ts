// SPDX-License-Identifier: Apache-2.0
// The interfaces between the viewer and the visitor's tools.
import type { Stage } from "../stage.ts";
import type { ViewerTexts } from "../../texts/index.ts";
import type { OrbitController } from "./orbit.ts";
import type { Overlay } from "./overlay.ts";

/** The functions of the element that the tools use. */
export interface ViewerControls {
  /** Restores the view that the page's attributes define. */
  frame(): void;
  /** Restores the level of detail that the page's attributes define. */
  sharpen(): void;
  /** Refines to a number of triangles, as if the visitor had chosen it. */
  choose(triangles: number): void;
  /** Whether the visitor has chosen the level of detail. */
  hasChosen(): boolean;
}

export interface Bench {
  readonly host: HTMLElement & { token: string };
  /** The container of the canvas. */
  readonly view: HTMLElement;
  readonly texts: ViewerTexts;
  readonly overlay: Overlay;
  readonly orbit: OrbitController;
  /** The stage of a model whose base mesh is shown. Available only between attach() and detach(). */
  readonly stage: Stage;
  readonly page: ViewerControls;
  /** Number of triangles shown now. */
  readonly triangles: number;
  /** Announces a text to screen readers. */
  say(text: string): void;
}

export interface Tool {
  /** Called when a model is on the stage. The tool must end its listeners and timers when `until` is aborted. */
  attach?(until: AbortSignal): void;
  /** Restores the initial settings. */
  reset?(): void;
  /** The tool's setting as a text for shared links. Empty for the initial setting. The setter ignores malformed texts. */
  setting?: string;
}
