// SPDX-License-Identifier: Apache-2.0
// Resets the viewer after `idle-reset` seconds without input, or without a new step of a tour. In a kiosk, this prepares the viewer
// for the next visitor.
import type { Bench, Tool } from "./bench.ts";

const kSigns = ["pointerdown", "pointermove", "wheel", "keydown", "focusin", "tour-step"] as const;

export class Idle implements Tool {
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly bench: Bench, private readonly leave: () => void) {}

  attach(until: AbortSignal): void {
    const options = { signal: until, passive: true, capture: true };
    for (const sign of kSigns) this.bench.host.addEventListener(sign, () => this.#stir(), options);
    until.addEventListener("abort", () => clearTimeout(this.#timer));
  }

  #stir(): void {
    clearTimeout(this.#timer);
    const seconds = Number.parseFloat(this.bench.host.getAttribute("idle-reset") ?? "");
    if (seconds > 0) this.#timer = setTimeout(this.leave, 1000 * seconds);
  }
}
