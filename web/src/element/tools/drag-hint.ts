// SPDX-License-Identifier: Apache-2.0
// Tells a visitor who does nothing for some seconds that the model can be turned. The hint is hidden from screen readers,
// because they read the names of the keys instead.
import type { Bench, Tool } from "./bench.ts";
import { make } from "./dom.ts";

const kHintDelay = 3000; // milliseconds without input until the hint appears

export class DragHint implements Tool {
  readonly #hint: HTMLElement;
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly bench: Bench) {
    this.#hint = make("p", { class: "drag-hint", hidden: true, "aria-hidden": "true" }, bench.texts.dragHint);
    bench.view.append(this.#hint);
  }

  attach(until: AbortSignal): void {
    for (const sign of ["pointerdown", "wheel", "keydown"]) this.bench.host.addEventListener(sign, () => this.#end(), { signal: until, passive: true, capture: true });
    until.addEventListener("abort", () => this.#end());
    this.reset();
  }

  /** Starts the wait again, for the next visitor of a kiosk. */
  reset(): void {
    this.#end();
    this.#timer = setTimeout(() => (this.#hint.hidden = !this.bench.stage.parts.controls.enabled), kHintDelay);
  }

  #end(): void {
    clearTimeout(this.#timer);
    this.#hint.hidden = true;
  }
}
