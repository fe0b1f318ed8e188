// SPDX-License-Identifier: Apache-2.0
// A contact shadow below the model. The page chooses it with the attribute shadow-intensity, as in model-viewer; the visitor can
// switch it on and off. The shadow's code is loaded at its first use.
import type { ContactShadow } from "../shadow/contact-shadow.ts";
import type { Stage } from "../stage.ts";
import type { Bench, Tool } from "./bench.ts";
import { checkbox } from "./dom.ts";

const kAttribute = "shadow-intensity";

export class Shadow implements Tool {
  readonly content: HTMLLabelElement;
  readonly #box: HTMLInputElement;
  #shadow: ContactShadow | undefined;

  constructor(private readonly bench: Bench) {
    this.content = checkbox("shadow", bench.texts.shadow, this.#intensity > 0, () => void this.#follow());
    this.#box = this.content.querySelector("input") as HTMLInputElement;
    bench.overlay.followers.add(() => this.#draw());
  }

  attach(until: AbortSignal): void {
    const { host, stage } = this.bench, forget = () => this.#shadow?.forget();
    const attribute = new MutationObserver(() => this.reset());
    attribute.observe(host, { attributeFilter: [kAttribute] });
    stage.mesh.addEventListener("refine", forget);
    stage.mesh.addEventListener("morph", forget);
    stage.parts.renderer.domElement.addEventListener("webglcontextrestored", forget, { signal: until });
    until.addEventListener("abort", () => {
      attribute.disconnect();
      this.#shadow?.dispose();
      this.#shadow = undefined;
    });
    void this.#follow();
  }

  reset(): void {
    this.#box.checked = this.#intensity > 0;
    void this.#follow();
  }

  get setting(): string {
    if (this.#box.checked === this.#intensity > 0) return "";
    return this.#box.checked ? "on" : "off";
  }
  set setting(text: string) {
    if (text !== "on" && text !== "off") return;
    this.#box.checked = text === "on";
    void this.#follow();
  }

  /** The value of the attribute. 0 if it is missing or malformed. */
  get #intensity(): number {
    const value = Number(this.bench.host.getAttribute(kAttribute) ?? 0);
    return value > 0 ? Math.min(value, 1) : 0;
  }

  async #follow(): Promise<void> {
    const { stage } = this.bench;
    // Ignores an error. The model is then shown without a shadow.
    if (this.#box.checked && !this.#shadow) await this.#load(stage).catch(() => undefined);
    void this.bench.stage?.draw();
  }

  async #load(stage: Stage): Promise<void> {
    const { ContactShadow } = await import("../shadow/contact-shadow.ts"), shadow = new ContactShadow(stage.parts.renderer, stage.mesh);
    await shadow.compile();
    if (this.#shadow || stage !== this.bench.stage) shadow.dispose();
    else this.#shadow = shadow;
  }

  #draw(): void {
    if (!this.#shadow || !this.#box.checked) return;
    this.#shadow.intensity = this.#intensity || 1;
    this.#shadow.draw(this.bench.stage.parts.camera);
  }
}
