// SPDX-License-Identifier: Apache-2.0
// Resets the viewer after `idle-reset` seconds without input and without a tour that plays. In a kiosk, this prepares the viewer for
// the next visitor.
import type { Bench, Tool } from "./bench.ts";

const kSigns = ["pointerdown", "pointermove", "wheel", "keydown", "focusin", "tour-step"] as const;
const kRest = "tour-rest"; // the viewer fires this event at the end of a tour

export class Idle implements Tool {
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly bench: Bench, private readonly leave: () => void) {}

  attach(until: AbortSignal): void {
    const options = { signal: until, passive: true, capture: true };
    for (const sign of kSigns) this.bench.host.addEventListener(sign, () => this.#stir(), options);
    this.bench.view.addEventListener(kRest, () => this.#stir(), options);
    until.addEventListener("abort", () => clearTimeout(this.#timer));
  }

  #stir(): void {
    clearTimeout(this.#timer);
    const seconds = Number.parseFloat(this.bench.host.getAttribute("idle-reset") ?? "");
    if (seconds > 0) this.#timer = setTimeout(() => this.#end(), 1000 * seconds);
  }

  /** Resets the viewer, unless a tour plays. */
  #end(): void {
    if (this.bench.view.classList.contains("playing")) this.#stir();
    else this.leave();
  }
}
