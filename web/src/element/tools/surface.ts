// SPDX-License-Identifier: Apache-2.0
// Settings for drawing the surface. The visitor's settings also apply to the next model.
import type { Bench, Tool } from "./bench.ts";
import { checkbox, make } from "./dom.ts";

const kToggles = { colours: true, facets: false, wireframe: false };
type Toggle = keyof typeof kToggles;

export class SurfaceStyle implements Tool {
  readonly content: HTMLElement;

  constructor(private readonly bench: Bench) {
    const boxes = this.#each((name, first) => checkbox(name, bench.texts[name], first, (on) => (bench.stage[name] = on)));
    this.content = make("div", {}, ...boxes);
  }

  attach(): void {
    const colours = this.#box("colours").closest("label") as HTMLElement;
    colours.hidden = !this.bench.stage.mesh.info.attributes.includes("colour");
    this.#each((name, first) => this.#box(name).checked !== first && (this.bench.stage[name] = !first));
  }

  reset(): void {
    this.#each((name, first) => {
      if (this.#box(name).checked !== first) this.#box(name).click();
    });
  }

  #each<T>(use: (name: Toggle, first: boolean) => T): T[] {
    return (Object.keys(kToggles) as Toggle[]).map((name) => use(name, kToggles[name]));
  }

  #box(name: Toggle): HTMLInputElement {
    return this.content.querySelector(`[name=${name}]`) as HTMLInputElement;
  }
}
