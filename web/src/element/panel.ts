// SPDX-License-Identifier: Apache-2.0
// The shadow tree of <progressive-mesh>: picture, poster, controls, messages.
import { texts } from "../texts.ts";
import style from "./element.css?text";

const kToggles = ["colours", "facets", "wireframe"] as const;
export type Toggle = (typeof kToggles)[number];

const kTemplate = `
  <div class="panel">
    <div class="view">
      <canvas part="canvas" tabindex="0" role="img"></canvas>
      <slot name="poster"><img part="poster" class="poster" alt="" hidden></slot>
      <p class="message" part="message" role="alert" hidden></p>
    </div>
    <div class="progress" part="progress" role="progressbar" aria-label="${texts.loading}"><div></div></div>
    <form class="controls" part="controls">
      <label class="detail"><span>${texts.detail}</span>
        <input type="range" name="detail" min="0" max="1000" value="0" disabled></label>
      <output><span class="triangles"></span><span class="bytes"></span></output>
      <span class="toggles">
        <label><input type="checkbox" name="colours" checked><span>${texts.colours}</span></label>
        <label><input type="checkbox" name="facets"><span>${texts.facets}</span></label>
        <label><input type="checkbox" name="wireframe"><span>${texts.wireframe}</span></label>
        <button type="button" name="reset">${texts.resetView}</button>
      </span>
    </form>
  </div>`;

export class Panel {
  onDetail: (fraction: number) => void = () => undefined;
  onToggle: (which: Toggle, on: boolean) => void = () => undefined;
  onReset: () => void = () => undefined;
  #held = false;

  /** The place of the picture. */
  readonly view: HTMLElement;

  constructor(private readonly root: ShadowRoot) {
    root.innerHTML = `<style>${style}</style>${kTemplate}`;
    this.view = this.#find(".view");
    this.alt = "";
    this.#detail.addEventListener("input", () => {
      this.#held = true;
      this.onDetail(Number(this.#detail.value) / 1000);
    });
    for (const which of kToggles) {
      const box = this.#find<HTMLInputElement>(`[name=${which}]`);
      box.addEventListener("change", () => this.onToggle(which, box.checked));
    }
    this.#find("[name=reset]").addEventListener("click", () => this.onReset());
    this.#find("form").addEventListener("submit", (event) => event.preventDefault());
  }

  set alt(text: string) {
    this.#find("canvas").setAttribute("aria-label", texts.viewOf(text));
  }

  /** A canvas that has no WebGL context yet, in the place of the old one. */
  newCanvas(): HTMLCanvasElement {
    const old = this.#find("canvas");
    const fresh = old.cloneNode() as HTMLCanvasElement;
    old.replaceWith(fresh);
    return fresh;
  }

  /** What the visitor has switched on: it holds for the next model too. */
  toggles(): [Toggle, boolean][] {
    return kToggles.map((which) => [which, this.#find<HTMLInputElement>(`[name=${which}]`).checked]);
  }

  /** As before the first model. */
  reset(): void {
    this.#held = false;
    this.message = "";
    this.progress = 0;
    this.#detail.disabled = true;
    this.#find("slot[name=poster]").hidden = false;
    this.#find("form").classList.remove("ready");
  }

  set poster(url: string | null) {
    const image = this.root.querySelector<HTMLImageElement>(".poster");
    if (!image) return;
    image.hidden = url === null;
    if (url !== null) image.src = url;
  }

  hidePoster(): void {
    this.#find("slot[name=poster]").hidden = true;
  }

  /** The model is there: the controls make sense now. */
  enable(coloured: boolean): void {
    this.#detail.disabled = false;
    this.#find<HTMLInputElement>("[name=colours]").closest("label")?.toggleAttribute("hidden", !coloured);
    this.#find("form").classList.add("ready");
  }

  /** Moves the slider along with the model, until the visitor has taken hold of it. */
  follow(fraction: number): void {
    if (!this.#held) this.#detail.value = String(Math.round(1000 * fraction));
  }

  counts(triangles: string, bytes: string): void {
    this.#find(".triangles").textContent = triangles;
    this.#find(".bytes").textContent = bytes;
    this.#detail.setAttribute("aria-valuetext", triangles);
  }

  set progress(fraction: number) {
    const bar = this.#find(".progress");
    bar.classList.toggle("done", fraction >= 1);
    bar.setAttribute("aria-valuenow", String(Math.round(100 * fraction)));
    (bar.firstElementChild as HTMLElement).style.transform = `scaleX(${fraction})`;
  }

  set message(text: string) {
    const place = this.#find(".message");
    place.textContent = text;
    place.hidden = text === "";
  }

  get #detail(): HTMLInputElement {
    return this.#find<HTMLInputElement>("[name=detail]");
  }

  #find<T extends HTMLElement = HTMLElement>(selector: string): T {
    return this.root.querySelector(selector) as T;
  }
}
