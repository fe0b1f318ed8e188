// SPDX-License-Identifier: Apache-2.0
// <progressive-mesh src poster alt max-triangles max-bytes target-error pixel-error transport>
import { assetsBeside } from "../core/client.ts";
import type { Transport } from "../core/source.ts";
import type { Level, Want } from "../core/types.ts";
import { textsFor, type Texts } from "../texts/index.ts";
import { Panel } from "./panel.ts";
import type { Stage } from "./stage.ts";
import type { Toolbox } from "./tools/toolbox.ts";

/** Milliseconds without a move after which a camera rests. */
const kRest = 100;

/**
 * Shows one model and sharpens it. `src`, `poster` and `alt` are properties too. Events: `first-paint` (the base mesh is on the screen, no
 * enhancement layer has been asked for yet), `progress` {bytes, total}, `refine` {triangles,
 * vertices, bytes} for each state shown, `load` (the level asked for is reached), `error`
 * {message}, `camera-change`. With `pixel-error` it fetches what its camera sees, to an error of
 * so many pixels, and goes on when that has moved.
 */
export class ProgressiveMeshElement extends HTMLElement {
  static readonly observedAttributes = ["src", "poster", "alt", "max-triangles", "max-bytes", "target-error", "pixel-error"];

  readonly #panel = new Panel(this.attachShadow({ mode: "open" }));
  readonly #size = new ResizeObserver(() => this.#fit());
  #stage: Stage | undefined;
  #painted = false; // the stage shows its base mesh: it can be refined and dressed
  #loads = 0;
  #resting: ReturnType<typeof setTimeout> | undefined;
  #texts!: Texts;
  #tools: Toolbox | undefined;

  get src(): string {
    return this.getAttribute("src") ?? "";
  }
  set src(url: string) {
    this.setAttribute("src", url);
  }
  get poster(): string {
    return this.getAttribute("poster") ?? "";
  }
  set poster(url: string) {
    this.setAttribute("poster", url);
  }
  get alt(): string {
    return this.getAttribute("alt") ?? "";
  }
  set alt(text: string) {
    this.setAttribute("alt", text);
  }

  connectedCallback(): void {
    this.#adopt();
    this.#panel.texts = this.#texts = textsFor(this);
    this.#panel.onDetail = (fraction) => void this.#refine(this.#wantAt(fraction));
    this.#panel.onChoose = (want) => void this.#refine(want);
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
    else if (this.#painted) void this.#sharpen();
  }

  /** Properties that were set before this class was known hide the accessors. */
  #adopt(): void {
    for (const name of ["src", "poster", "alt"] as const) {
      if (!Object.hasOwn(this, name)) continue;
      const value = this[name];
      delete (this as Partial<typeof this>)[name];
      this[name] = value;
    }
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
      if (load !== this.#loads) return;
      await this.#firstPaint(stage);
      if (load !== this.#loads) return;
      this.#painted = true;
      this.#panel.hidePoster();
      this.#emit("first-paint");
      this.#equip(stage).catch(() => undefined); // the browser tells; the model is shown all the same
      await this.#sharpen();
    } catch (error) {
      if (load === this.#loads) this.#fail(error as Error);
    }
  }

  #open(stage: Stage): Stage {
    this.#stage = stage;
    stage.onCamera = () => {
      this.#emit("camera-change");
      this.#follow();
    };
    stage.mesh.addEventListener("progress", ({ bytes, total }) => this.#progress(bytes, total));
    stage.mesh.addEventListener("refine", ({ surface }) => this.#show(surface));
    return stage;
  }

  async #firstPaint(stage: Stage): Promise<void> {
    this.#fit();
    stage.frame();
    this.#panel.enable(stage.mesh.info);
    await stage.draw();
  }

  /** The visitor's tools come after the first picture. */
  async #equip(stage: Stage): Promise<void> {
    const { Toolbox } = await import("./tools/toolbox.ts");
    if (stage !== this.#stage) return;
    this.#tools ??= new Toolbox(this, this.#panel, this.#texts);
    this.#tools.attach(stage, { frame: () => stage.frame(), sharpen: () => void this.#sharpen() });
  }

  /** Towards what the attributes ask for. */
  #sharpen(): Promise<void> {
    const pixels = this.#number("pixel-error");
    return this.#reach((stage) => (pixels > 0 ? stage.refine(pixels) : stage.mesh.refine(this.#goal())));
  }

  /** Where the camera decides what is fetched, it does so anew once it rests. */
  #follow(): void {
    clearTimeout(this.#resting);
    if (this.#painted && this.#number("pixel-error") > 0) this.#resting = setTimeout(() => void this.#sharpen(), kRest);
  }

  #refine(want: Want): Promise<void> {
    return this.#reach((stage) => stage.mesh.refine(want));
  }

  async #reach(refine: (stage: Stage) => Promise<boolean>): Promise<void> {
    const stage = this.#stage;
    if (!stage) return;
    this.#panel.choice.begin();
    try {
      if (!(await refine(stage)) || stage !== this.#stage) return;
      await stage.draw();
      this.#panel.progress = 1;
      this.#emit("load");
    } catch (error) {
      if (stage === this.#stage) this.#fail(error as Error);
    }
  }

  #show(surface: { triangles: number; vertices: number; bytes: number }): void {
    this.#panel.choice.show(surface, !(this.#number("pixel-error") > 0));
    this.#panel.follow(this.#fractionOf(surface.triangles));
    this.#emit("refine", surface);
  }

  #fit(): void {
    const { clientWidth, clientHeight } = this.#panel.view;
    this.#stage?.resize(clientWidth, clientHeight);
    this.#follow();
  }

  #progress(bytes: number, total: number): void {
    this.#panel.progress = total > 0 ? bytes / total : 1;
    this.#panel.choice.arrived(bytes);
    this.#emit("progress", { bytes, total });
  }

  #fail(error: Error): void {
    this.#panel.message = this.#stage ? error.message : `${this.#texts.noWebGl} ${error.message}`;
    this.#emit("error", { message: error.message });
  }

  #clear(): void {
    ++this.#loads;
    clearTimeout(this.#resting);
    this.#tools?.detach();
    this.#stage?.dispose();
    this.#stage = undefined;
    this.#painted = false;
    this.#panel.reset();
  }

  get #transport(): Transport {
    const value = this.getAttribute("transport");
    return value === "http" || value === "ws" ? value : "auto";
  }

  #number(name: string): number {
    return Number.parseFloat(this.getAttribute(name) ?? "");
  }

  /** What the attributes ask for; without them full resolution. */
  #goal(): Want {
    const triangles = this.#number("max-triangles"), bytes = this.#number("max-bytes"), error = this.#number("target-error");
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
