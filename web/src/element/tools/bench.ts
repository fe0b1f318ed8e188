// SPDX-License-Identifier: Apache-2.0
// What the tools share.
import type { Stage } from "../stage.ts";
import type { Texts } from "../../texts/index.ts";
import type { Orbit } from "./orbit.ts";
import type { Overlay } from "./overlay.ts";

/** The view and the detail that the page asks for. */
export interface Page {
  frame(): void;
  sharpen(): void;
}

export interface Bench {
  readonly host: HTMLElement & { token: string };
  /** The place of the picture. */
  readonly view: HTMLElement;
  readonly texts: Texts;
  readonly overlay: Overlay;
  readonly orbit: Orbit;
  /** With a model whose base mesh is shown: there is one between attach() and detach(). */
  readonly stage: Stage;
  /** What the page has asked for. */
  readonly page: Page;
  /** Shown now. */
  readonly triangles: number;
  /** Says something to those who listen to the page. */
  say(text: string): void;
}

export interface Tool {
  /** A model is on the stage; what begins here ends with `until`. */
  attach?(until: AbortSignal): void;
  /** As before the visitor came. */
  reset?(): void;
}
