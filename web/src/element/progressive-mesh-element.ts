// SPDX-License-Identifier: Apache-2.0
// <progressive-mesh src poster alt max-triangles max-bytes target-error transport>
import { assetsBeside } from "../core/client.ts";
import type { Transport } from "../core/source.ts";
import type { Level, Want } from "../core/types.ts";
import { texts } from "../texts.ts";
import { Panel } from "./panel.ts";
import type { Stage } from "./stage.ts";

/**
 * Shows one model and sharpens it. Events: `first-paint` (the base mesh is on the screen, no
 * enhancement layer has been asked for yet), `progress` {bytes, total}, `refine` {triangles,
 * vertices, bytes} for each state shown, `load` (the level asked for is reached), `error`
 * {message}, `camera-change`.
 */
export class ProgressiveMeshElement extends HTMLElement {
  static readonly observedAttributes = ["src", "poster", "alt", "max-triangles", "max-bytes", "target-error"];

  readonly #panel = new Panel(this.attachShadow({ mode: "open" }));
  readonly #size = new ResizeObserver(() => this.#fit());
  #stage: Stage | undefined;
  #loads = 0;

  connectedCallback(): void {
    this.#panel.onDetail = (fraction) => void this.#refine(this.#wantAt(fraction));
    this.#panel.onToggle = (which, on) => this.#stage && (this.#stage[which] = on);
    this.#panel.onReset = () => this.#stage?.frame();
    this.#size.observe(this.#panel.view);
    void this.#load();
  }

  disconnectedCallback(): void {
    this.#size.disconnect();
    this.#clear();
  }

  attributeChangedCallback(name: string, before: string | null, value: string | null): void {
    if (name === "alt") this.#panel.alt = value ?? "";
    else if (name === "poster") this.#panel.poster = value;
    else if (!this.isConnected || before === value) return;
    else if (name === "src") void this.#load();
    else if (this.#stage) void this.#refine(this.#goal());
  }

  async #load(): Promise<void> {
    this.#clear();
    const src = this.getAttribute("src");
    if (!src) return;
    const load = this.#loads;
    try {
      const { Stage } = await import("./stage.ts");
      if (load !== this.#loads) return;
      const stage = this.#open(new Stage(this.#panel.newCanvas(), src, assetsBeside(import.meta.url), this.#transport));
      await stage.mesh.ready;
      await this.#firstPaint(stage);
      if (load === this.#loads) await this.#refine(this.#goal());
    } catch (error) {
      if (load === this.#loads) this.#fail(error as Error);
    }
  }

  #open(stage: Stage): Stage {
    this.#stage = stage;
    stage.onCamera = () => this.#emit("camera-change");
    stage.mesh.addEventListener("progress", ({ bytes, total }) => this.#progress(bytes, total));
    stage.mesh.addEventListener("refine", ({ surface }) => this.#show(surface));
    return stage;
  }

  async #firstPaint(stage: Stage): Promise<void> {
    this.#fit();
    stage.frame();
    this.#panel.enable(stage.mesh.info.coloured);
    await stage.draw();
    this.#panel.hidePoster();
    this.#emit("first-paint");
  }

  async #refine(want: Want): Promise<void> {
    const stage = this.#stage;
    if (!stage) return;
    try {
      if (!(await stage.mesh.refine(want)) || stage !== this.#stage) return;
      await stage.draw();
      this.#panel.progress = 1;
      this.#emit("load");
    } catch (error) {
      if (stage === this.#stage) this.#fail(error as Error);
    }
  }

  #show(surface: { triangles: number; vertices: number; bytes: number }): void {
    const { fileBytes } = this.#info;
    this.#panel.counts(
      texts.triangles(surface.triangles, this.#finest.faces),
      texts.bytes(surface.bytes, fileBytes),
    );
    this.#panel.follow(this.#fractionOf(surface.triangles));
    this.#emit("refine", surface);
  }

  #fit(): void {
    const { clientWidth, clientHeight } = this.#panel.view;
    this.#stage?.resize(clientWidth, clientHeight);
  }

  #progress(bytes: number, total: number): void {
    this.#panel.progress = total > 0 ? bytes / total : 1;
    this.#emit("progress", { bytes, total });
  }

  #fail(error: Error): void {
    this.#panel.message = this.#stage ? error.message : `${texts.noWebGl} ${error.message}`;
    this.#emit("error", { message: error.message });
  }

  #clear(): void {
    ++this.#loads;
    this.#stage?.dispose();
    this.#stage = undefined;
    this.#panel.reset();
  }

  get #transport(): Transport {
    const value = this.getAttribute("transport");
    return value === "http" || value === "ws" ? value : "auto";
  }

  /** What the attributes ask for; without them full resolution. */
  #goal(): Want {
    const number = (name: string) => Number.parseFloat(this.getAttribute(name) ?? "");
    const triangles = number("max-triangles"), bytes = number("max-bytes"), error = number("target-error");
    if (triangles >= 0) return { triangles };
    if (bytes >= 0) return { bytes };
    if (error >= 0) return { error };
    return { level: this.#info.levels.length - 1 };
  }

  /** The slider runs over the logarithm of the triangle count. */
  #wantAt(fraction: number): Want {
    if (fraction >= 1) return { level: this.#info.levels.length - 1 };
    if (fraction <= 0) return { level: 0 };
    const coarse = this.#coarsest.faces;
    return { triangles: Math.round(coarse * (this.#finest.faces / coarse) ** fraction) };
  }

  #fractionOf(triangles: number): number {
    const coarse = this.#coarsest.faces;
    return this.#finest.faces > coarse ? Math.log(triangles / coarse) / Math.log(this.#finest.faces / coarse) : 1;
  }

  get #info() {
    return (this.#stage as Stage).mesh.info;
  }
  get #coarsest(): Level {
    return this.#info.levels[0] as Level;
  }
  get #finest(): Level {
    return this.#info.levels[this.#info.levels.length - 1] as Level;
  }

  #emit(type: string, detail?: object): void {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}
