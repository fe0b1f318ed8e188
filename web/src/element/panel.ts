// SPDX-License-Identifier: Apache-2.0
// The shadow tree of <progressive-mesh>: canvas, poster, messages, the controls of detail, and a
// container for the tools. The tools (tools/toolbox.ts) are loaded later.
import type { ModelInfo, Want } from "../core/types.ts";
import type { ViewerTexts } from "../texts/index.ts";
import { Choice, kChoice } from "./choice.ts";
import style from "./element.css?text";

const kTemplate = `
  <div class="panel">
    <div class="view">
      <canvas part="canvas" tabindex="0" role="img" aria-describedby="keys"></canvas>
      <slot name="poster"><img part="poster" class="poster" alt="" hidden></slot>
      <p class="message" part="message" role="alert" hidden></p>
      <p class="heard" id="keys" data-text="keys"></p>
    </div>
    <div class="progress" part="progress" role="progressbar" data-label="loading"><div></div></div>
    <form class="controls" part="controls">${kChoice}<div class="tools" role="toolbar" data-label="tools"></div></form>
  </div>`;

export class Panel {
  onDetail: (fraction: number) => void = () => undefined;
  readonly choice: Choice;
  readonly #styles = new Set<string>();
  #isHeld = false;
  #alt = "";
  #texts: ViewerTexts | undefined;

  /** The container of the canvas. */
  readonly view: HTMLElement;

  constructor(readonly root: ShadowRoot) {
    this.style(style);
    root.innerHTML = kTemplate;
    this.view = this.#find(".view");
    this.choice = new Choice(root);
    this.#detail.addEventListener("input", () => {
      this.#isHeld = true;
      this.onDetail(Number(this.#detail.value) / 1000);
    });
    this.#find("form").addEventListener("submit", (event) => event.preventDefault());
  }

  /**
   * Adds a style sheet to the shadow tree, unless the tree has it. Unlike a <style> element, the sheet works under a content
   * security policy that forbids inline styles.
   */
  style(css: string): void {
    if (this.#styles.has(css)) return;
    this.#styles.add(css);
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(css);
    this.root.adoptedStyleSheets = [...this.root.adoptedStyleSheets, sheet];
  }

  set onChoose(choose: (want: Want) => void) {
    this.choice.onChoose = (want) => {
      this.#isHeld = false;
      choose(want);
    };
  }

  /** Sets all texts that do not depend on the model. */
  set texts(texts: ViewerTexts) {
    this.#texts = this.choice.texts = texts;
    const write = (name: string, use: (place: Element, text: string) => void) => {
      for (const place of this.root.querySelectorAll(`[data-${name}]`)) use(place, texts[place.getAttribute(`data-${name}`) as "keys"]);
    };
    write("text", (place, text) => (place.textContent = text));
    write("label", (place, text) => (place.ariaLabel = text));
    this.alt = this.#alt;
  }

  set alt(text: string) {
    this.#alt = text;
    if (this.#texts) this.#find("canvas").setAttribute("aria-label", this.#texts.viewOf(text));
  }

  /** Replaces the canvas by one that has no WebGL context yet, and returns it. */
  newCanvas(): HTMLCanvasElement {
    const old = this.#find("canvas");
    const fresh = old.cloneNode() as HTMLCanvasElement;
    old.replaceWith(fresh);
    return fresh;
  }

  /** Restores the panel's initial state, in which there is no model. */
  reset(): void {
    this.#isHeld = false;
    this.message = "";
    this.progress = 0;
    this.#detail.disabled = true;
    this.choice.disable();
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

  /** Enables the controls. Called when the model is loaded. */
  enable(info: ModelInfo): void {
    this.#detail.disabled = false;
    this.choice.enable(info);
    this.#find("form").classList.add("ready");
  }

  /** Moves the slider to the detail shown, unless the visitor has set the slider. */
  follow(fraction: number): void {
    if (!this.#isHeld) this.#detail.value = String(Math.round(1000 * fraction));
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
