// SPDX-License-Identifier: Apache-2.0
// Shows a link as a QR code, which a phone reads from the screen of a kiosk. The code that draws it is loaded when it is first used.
import type { Bench } from "./bench.ts";
import { make } from "./dom.ts";

export class QrSheet {
  readonly button: HTMLButtonElement;
  readonly content = make("div", { class: "qr", hidden: true });
  #link = "";

  constructor(private readonly bench: Bench) {
    this.button = make("button", { type: "button", class: "framed", name: "qr", "aria-expanded": "false", onclick: () => this.#toggle() }, bench.texts.qr);
  }

  /** The link. If its QR code is shown, draws it again. */
  set link(link: string) {
    if (link === this.#link) return;
    this.#link = link;
    if (!this.content.hidden) void this.#draw();
  }

  #toggle(): void {
    this.content.hidden = !this.content.hidden;
    this.button.ariaExpanded = String(!this.content.hidden);
    if (!this.content.hidden) void this.#draw();
  }

  async #draw(): Promise<void> {
    const link = this.#link, { texts } = this.bench;
    const code = await import("../qr/qr-code.ts").then(({ qrCode }) => qrCode(link, texts.qrOf), () => undefined).catch(() => undefined);
    if (link !== this.#link) return;
    this.content.replaceChildren(code ?? texts.qrMissing);
    this.content.scrollIntoView({ block: "nearest" });
  }
}
