// SPDX-License-Identifier: Apache-2.0
// Announces to screen readers from where the visitor sees the model, once the camera is at rest.
// Also announces how far the model has been refined, at milestones only.
import type { Bench, Tool } from "./bench.ts";
import { heightOf, sideOf } from "./view.ts";

/** Milliseconds without movement after which the camera counts as at rest. */
const kRest = 600;

/**
 * Whether the number of downloaded bytes passes half of `total`, without reaching `total`, when it
 * changes from `before` to `now`.
 */
export function passesHalf(before: number, now: number, total: number): boolean {
  return before < total / 2 && now >= total / 2 && now < total;
}

export class Announcer implements Tool {
  #seen = "";
  #bytes = 0;
  // Whether the next `load` event is announced: the first one, and each that the visitor has requested.
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
    if (this.bench.triangles === info.levels.at(-1)?.faces) this.#reached(); // full detail was reached before the tools were loaded
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
