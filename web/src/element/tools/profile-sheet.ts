// SPDX-License-Identifier: Apache-2.0
// Shows the profile along a cut, and saves it as CSV and SVG. The code that computes profiles is loaded at its first
// use.
import type { Cut } from "../profile/profile.ts";
import type { Bench } from "./bench.ts";
import { make, save } from "./dom.ts";
import { unpackDepth } from "./pick.ts";

export class ProfileSheet {
  readonly content: HTMLElement;
  readonly #drawing = make("div", { class: "profile", role: "img", "aria-label": "" });
  #files: Record<"CSV" | "SVG", string> = { CSV: "", SVG: "" };
  #cut: Cut | undefined;

  constructor(private readonly bench: Bench) {
    const button = (kind: "CSV" | "SVG", type: string) =>
      make("button", { type: "button", class: "framed", onclick: () => save(new Blob([this.#files[kind]], { type }), `profile.${kind.toLowerCase()}`) }, kind);
    this.#drawing.ariaLabel = bench.texts.measures.profile;
    this.content = make("div", { hidden: true }, this.#drawing, make("div", { class: "row" }, button("CSV", "text/csv"), button("SVG", "image/svg+xml")));
  }

  hide(): void {
    this.#cut = undefined;
    this.content.hidden = true;
  }

  async show(cut: Cut): Promise<void> {
    this.#cut = cut;
    // Ignores an error. The length of the cut is then shown alone.
    const code = await import("../profile/profile.ts").catch(() => undefined);
    if (!code || cut !== this.#cut) return;
    const { stage, texts } = this.bench, { mesh } = stage, { info } = mesh;
    const samples = code.profileOf(stage.parts.renderer, mesh, cut, unpackDepth);
    this.#files = { CSV: code.csvOf(samples, info.unit), SVG: code.svgOf(samples, (value) => texts.measured(value, info.unit)) };
    const { documentElement } = new DOMParser().parseFromString(this.#files.SVG, "image/svg+xml");
    this.#drawing.replaceChildren(documentElement);
    this.content.hidden = samples.length === 0;
  }
}
