// SPDX-License-Identifier: Apache-2.0
// Lets the visitor save a picture, a link to the current view, and the model at a level of detail.
import type { Bench, Tool } from "./bench.ts";
import { make } from "./dom.ts";
import { apiOf, exportOf, kFormats, linkTo, viewIn, type ExportDetail } from "./links.ts";

type DownloadLevel = "shown" | "highest" | "lowest";

export class Save implements Tool {
  readonly content: HTMLElement;
  readonly #link: HTMLInputElement;
  readonly #said = make("p", { class: "hint" });
  readonly #download: HTMLElement;
  readonly #format: HTMLSelectElement;
  readonly #level: HTMLSelectElement;
  readonly #file: HTMLAnchorElement;

  constructor(private readonly bench: Bench) {
    const { texts } = bench;
    const picture = make("button", { type: "button", class: "framed", onclick: () => void this.#picture() }, texts.screenshot);
    this.#link = make("input", { readonly: true, name: "link", "aria-label": texts.link, onfocus: () => this.#link.select() });
    const copy = make("button", { type: "button", class: "framed", onclick: () => void this.#copy() }, texts.copy);
    const change = () => this.#aim();
    const formats = kFormats.map((name) => option(name, name.toUpperCase()));
    this.#format = make("select", { name: "format", "aria-label": texts.format, onchange: change }, ...formats);
    this.#level = make("select", { name: "level", "aria-label": texts.quality, onchange: change });
    this.#file = make("a", { class: "framed", download: "" }, texts.download);
    this.#download = make("div", { class: "row" }, this.#level, this.#format);
    this.content = make("div", {}, picture, make("p", { class: "label" }, texts.link), make("div", { class: "row" }, this.#link, copy),
      this.#said, make("p", { class: "label" }, texts.download), this.#download, this.#file);
  }

  attach(until: AbortSignal): void {
    const { host } = this.bench;
    const restore = () => {
      const view = viewIn(location.hash, host.id);
      if (view) this.bench.orbit.view = view;
    };
    addEventListener("hashchange", restore, { signal: until });
    host.addEventListener("camera-change", () => this.content.checkVisibility() && this.refresh(), { signal: until });
    restore();
  }

  /**
   * Updates all links to the current state. Called when the sheet opens, and when the camera moves while it is open.
   */
  refresh(): void {
    const { host, orbit, stage, texts, triangles } = this.bench, { levels } = stage.mesh.info;
    const coarse = levels[0]?.faces ?? 0, fine = levels.at(-1)?.faces ?? 0;
    this.#link.value = linkTo(location.href, host.id, orbit.view);
    this.#said.textContent = "";
    const chosen = this.#level.value;
    this.#level.replaceChildren(
      option("highest", texts.original(fine)), option("shown", texts.asShown(triangles)), option("lowest", texts.coarsest(coarse)));
    this.#level.value = chosen || "highest";
    this.#aim();
  }

  #aim(): void {
    const { host, texts } = this.bench, src = new URL(host.getAttribute("src") ?? "", document.baseURI).href, api = apiOf(src);
    const level = this.#level.value as DownloadLevel;
    const amount: ExportDetail = level === "shown" ? { triangles: this.bench.triangles } : { level };
    this.#download.hidden = api === undefined || host.token !== "";
    this.#file.hidden = host.token !== ""; // a link does not send the token
    this.#file.textContent = api === undefined ? texts.fileAlone : texts.download;
    this.#file.href = api === undefined ? src : exportOf(api, this.#format.value, amount);
  }

  async #picture(): Promise<void> {
    await this.bench.stage.draw();
    const { domElement } = this.bench.stage.parts.renderer;
    domElement.toBlob((picture) => {
      if (!picture) return;
      const address = URL.createObjectURL(picture);
      make("a", { href: address, download: `${this.#name}.png` }).click();
      URL.revokeObjectURL(address);
    }, "image/png");
  }

  async #copy(): Promise<void> {
    const { texts } = this.bench;
    this.#link.select();
    // Pages without TLS have no access to the clipboard.
    const isCopied = await (navigator.clipboard?.writeText(this.#link.value) ?? Promise.reject()).then(() => true, () => false);
    this.#said.textContent = isCopied ? texts.copied : texts.copyByHand;
    this.bench.say(this.#said.textContent);
    if (!isCopied) this.#link.focus();
  }

  get #name(): string {
    return (this.bench.host.getAttribute("alt") ?? "").replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").toLowerCase() || "model";
  }
}

function option(value: string, text: string): HTMLOptionElement {
  return make("option", { value }, text);
}
