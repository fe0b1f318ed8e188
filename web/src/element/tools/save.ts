// SPDX-License-Identifier: Apache-2.0
// Lets the visitor save a picture, share a link to what is shown (also as a QR code), and save the model at a level of detail.
import type { Bench, Tool } from "./bench.ts";
import { make, save } from "./dom.ts";
import { apiOf, exportOf, kFormats, linkTo, settingIn, type ExportDetail } from "./links.ts";
import { QrSheet } from "./qr-sheet.ts";
import { formatView, parseView } from "./view.ts";

type DownloadLevel = "shown" | "highest" | "lowest";

export class Save implements Tool {
  readonly content: HTMLElement;
  readonly #link: HTMLInputElement;
  readonly #said = make("p", { class: "hint" });
  readonly #qr: QrSheet;
  readonly #download: HTMLElement;
  readonly #format: HTMLSelectElement;
  readonly #level: HTMLSelectElement;
  readonly #file: HTMLAnchorElement;

  /** A shared link contains the settings of the tools `kept`. The key of each tool is the setting's name in the link. */
  constructor(private readonly bench: Bench, private readonly kept: Record<string, Tool>) {
    const { texts } = bench;
    const picture = make("button", { type: "button", class: "framed", onclick: () => void this.#picture() }, texts.screenshot);
    this.#link = make("input", { readonly: true, name: "link", "aria-label": texts.link, onfocus: () => this.#link.select() });
    const copy = make("button", { type: "button", class: "framed", onclick: () => void this.#copy() }, texts.copy);
    const share = make("button", { type: "button", class: "framed", hidden: !("share" in navigator), onclick: () => void this.#share() }, texts.share);
    this.#qr = new QrSheet(bench);
    const change = () => this.#aim();
    const formats = kFormats.map((name) => option(name, name.toUpperCase()));
    this.#format = make("select", { name: "format", "aria-label": texts.format, onchange: change }, ...formats);
    this.#level = make("select", { name: "level", "aria-label": texts.quality, onchange: change });
    this.#file = make("a", { class: "framed", download: "" }, texts.download);
    this.#download = make("div", { class: "row" }, this.#level, this.#format);
    this.content = make("div", {}, picture, make("p", { class: "label" }, texts.link), make("div", { class: "row" }, this.#link, copy),
      make("div", { class: "row equal" }, share, this.#qr.button), this.#said, this.#qr.content, make("p", { class: "label" }, texts.download), this.#download, this.#file);
  }

  attach(until: AbortSignal): void {
    const { host } = this.bench;
    addEventListener("hashchange", () => this.#restore(), { signal: until });
    host.addEventListener("camera-change", () => this.content.checkVisibility() && this.refresh(), { signal: until });
    this.#restore();
  }

  /** Restores the settings in the page's link. */
  #restore(): void {
    const { bench } = this, setting = (name: string) => settingIn(location.hash, bench.host.id, name);
    const view = parseView(setting("view")), triangles = Number(setting("detail"));
    if (view) bench.orbit.view = view;
    for (const [name, tool] of Object.entries(this.kept)) tool.setting = setting(name);
    if (triangles > 0) bench.page.choose(triangles);
  }

  /** The settings that a shared link contains. It contains the level of detail only if the visitor has chosen one. */
  get #settings(): Record<string, string> {
    const { orbit, page, triangles } = this.bench;
    const kept = Object.entries(this.kept).map(([name, tool]) => [name, tool.setting ?? ""]);
    return { view: formatView(orbit.view), ...Object.fromEntries(kept), detail: page.hasChosen() ? String(triangles) : "" };
  }

  /**
   * Updates all links to the current state. Called when the sheet opens, and when the camera moves
   * while the sheet is open.
   */
  refresh(): void {
    const { host, stage, texts, triangles } = this.bench, { levels } = stage.mesh.info;
    const coarse = levels[0]?.faces ?? 0, fine = levels.at(-1)?.faces ?? 0;
    this.#qr.link = this.#link.value = linkTo(location.href, host.id, this.#settings);
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
    this.#file.hidden = host.token !== ""; // a link cannot send the token
    this.#file.textContent = api === undefined ? texts.fileAlone : texts.download;
    this.#file.href = api === undefined ? src : exportOf(api, this.#format.value, amount);
  }

  async #picture(): Promise<void> {
    await this.bench.stage.draw();
    const { domElement } = this.bench.stage.parts.renderer;
    domElement.toBlob((picture) => {
      if (picture) save(picture, `${this.#name}.png`);
    }, "image/png");
  }

  async #copy(): Promise<void> {
    const { texts } = this.bench;
    this.#link.select();
    // Pages without TLS cannot use the clipboard.
    const isCopied = await (navigator.clipboard?.writeText(this.#link.value) ?? Promise.reject()).then(() => true, () => false);
    this.#said.textContent = isCopied ? texts.copied : texts.copyByHand;
    this.bench.say(this.#said.textContent);
    if (!isCopied) this.#link.focus();
  }

  /** Opens the system's dialog for sharing. If the browser refuses, for example in a frame, copies the link. */
  async #share(): Promise<void> {
    try {
      await navigator.share({ title: this.bench.host.getAttribute("alt") ?? "", url: this.#link.value });
    } catch (error) {
      // An AbortError says that the visitor has closed the dialog.
      if ((error as Error).name !== "AbortError") await this.#copy();
    }
  }

  get #name(): string {
    return (this.bench.host.getAttribute("alt") ?? "").replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").toLowerCase() || "model";
  }
}

function option(value: string, text: string): HTMLOptionElement {
  return make("option", { value }, text);
}
