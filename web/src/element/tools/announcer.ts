// SPDX-License-Identifier: Apache-2.0
// Tells screen readers from which side the visitor sees the model, once the camera is at rest. Also
// announces how far the model has been refined, but only at a few milestones.
import type { Bench, Tool } from "./bench.ts";
import { heightOf, sideOf } from "./view.ts";

/** Milliseconds without movement after which the camera counts as at rest. */
const kRest = 600;

/**
 * Returns whether the number of downloaded bytes, changing from `before` to `now`, passes half of
 * `total` without reaching `total`.
 */
export function passesHalf(before: number, now: number, total: number): boolean {
  return before < total / 2 && now >= total / 2 && now < total;
}

export class Announcer implements Tool {
  #seen = "";
  #bytes = 0;
  // Whether the next `load` event is announced. The first event is announced, and each event that
  // follows a request of the visitor.
  #hasAsked = false;
  #resting: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly bench: Bench) {}

  attach(until: AbortSignal): void {
    const { host, stage, texts } = this.bench, { info } = stage.mesh;
    this.#seen = this.#words();
    this.#bytes = info.levels[0]?.cumulativeBytes ?? 0;
    const options = { signal: until };
    host.addEventListener("camera-change", () => this.#move(), options);
    host.addEventListener("refine", (event) => {
      const { bytes } = (event as CustomEvent<{ bytes: number }>).detail;
      if (passesHalf(this.#bytes, bytes, info.fileBytes)) this.bench.say(texts.halfway);
      this.#bytes = bytes;
    }, options);
    host.addEventListener("load", () => this.#hasAsked && this.#reached(), options);
    this.#hasAsked = true;
    const ask = ({ target }: Event) => (this.#hasAsked ||= (target as Element).closest(".choice, .detail") !== null);
    for (const sign of ["click", "input"]) this.bench.view.parentElement?.addEventListener(sign, ask, options);
    until.addEventListener("abort", () => clearTimeout(this.#resting));
    // Announces full detail if it was already reached before the tools were loaded.
    if (this.bench.triangles === info.levels.at(-1)?.faces) this.#reached();
    else this.bench.say(texts.firstShape(this.bench.triangles));
  }

  #reached(): void {
    this.#hasAsked = false;
    this.bench.say(this.bench.texts.reached(this.bench.triangles));
  }

  #move(): void {
    clearTimeout(this.#resting);
    this.#resting = setTimeout(() => {
      const words = this.#words();
      if (words !== this.#seen) this.bench.say((this.#seen = words));
    }, kRest);
  }

  #words(): string {
    const { azimuth, elevation } = this.bench.orbit.view;
    return this.bench.texts.seenFrom(sideOf(azimuth), heightOf(elevation));
  }
}
