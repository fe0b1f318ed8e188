// SPDX-License-Identifier: Apache-2.0
// The custom element <progressive-mesh>.
import { RemoteModel, assetsBeside } from "../core/client.ts";
import type { Transport } from "../core/source.ts";
import { ModelError, type Level, type Want } from "../core/types.ts";
import { textsFor, type ViewerTexts } from "../texts/index.ts";
import { Panel } from "./panel.ts";
import type { CameraWords, Stage } from "./stage.ts";
import type { Toolbox } from "./tools/toolbox.ts";

/** Milliseconds between two detail requests while the camera moves. */
const kLook = 200;

const kCamera = ["camera-orbit", "camera-target", "field-of-view"];
const kAmounts = ["max-triangles", "max-bytes", "target-error", "pixel-error"];

/**
 * Shows one model and refines it. All attributes may change at any time; those without a description work
 * as in model-viewer:
 * - `src` (the URL of a .pmesh file, a model page or an API model), `poster` and `alt`, which are also properties;
 * - `loading` (eager, or lazy: loads when near the viewport), `reveal` (auto, or manual: the poster stays until dismissPoster());
 * - `camera-controls`, `touch-action` (pan-y), `camera-orbit`, `camera-target`, `field-of-view`, `auto-rotate`;
 * - `pixel-error` (default 1): fetches what the camera sees, to an error of this many device pixels, and continues as the camera
 *   moves; 0 fetches the whole model. One of `max-triangles`, `max-bytes` and `target-error` (model units) requests a fixed state instead;
 * - `transport` (auto, http or ws).
 * Events: `first-paint` (the base mesh is on the screen, no enhancement layer has been requested
 * yet), `progress` {bytes, total}, `refine` {triangles, vertices, bytes} for each state shown,
 * `load` (the requested detail is reached), `error` {message}, `camera-change` {source}.
 */
export class ProgressiveMeshElement extends HTMLElement {
  static readonly observedAttributes = [
    "src", "poster", "alt", "transport", "loading", "reveal", "camera-controls", "touch-action", "auto-rotate", ...kCamera, ...kAmounts,
  ];

  readonly #panel = new Panel(this.attachShadow({ mode: "open" }));
  readonly #size = new ResizeObserver(() => this.#fit());
  readonly #language = new MutationObserver(() => this.#speak());
  readonly #near = new IntersectionObserver((seen) => seen.some(({ isIntersecting }) => isIntersecting) && void this.#load(), { rootMargin: "50%" });
  #model: RemoteModel | undefined;
  #stage: Stage | undefined;
  #isPainted = false; // whether the base mesh is on the screen, so that the model can be refined and the tools attached
  #loads = 0;
  #looking: ReturnType<typeof setTimeout> | undefined;
  #hasChosen = false; // whether the visitor has chosen a detail; camera movements then request no other detail
  #spoken: Promise<ViewerTexts> | undefined; // texts in the element's language
  #texts: ViewerTexts | undefined;
  #token = "";
  #tools: Toolbox | undefined;

  /** Token sent to the daemon for a model that is not public. Not an attribute, because a page's HTML may be copied and stored. */
  get token(): string {
    return this.#token;
  }
  set token(token: string) {
    if (token === this.#token) return;
    this.#token = token;
    if (this.isConnected) this.#begin();
  }
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

  /** The camera position: angles in radians, distance from the target in model units. */
  getCameraOrbit(): { theta: number; phi: number; radius: number } | undefined {
    return this.#isPainted ? this.#stage?.orbit : undefined;
  }

  /** The point that the camera looks at, in model coordinates. */
  getCameraTarget(): [number, number, number] | undefined {
    return this.#isPainted ? this.#stage?.target : undefined;
  }

  /** The vertical field of view, degrees. */
  getFieldOfView(): number | undefined {
    return this.#isPainted ? this.#stage?.fieldOfView : undefined;
  }

  /** Hides the poster if `reveal` is manual: immediately if the base mesh is on the screen, else as soon as it is. */
  dismissPoster(): void {
    if (this.#isPainted) this.#panel.hidePoster();
    else this.setAttribute("reveal", "auto");
  }

  connectedCallback(): void {
    this.#adopt();
    this.#speak();
    this.#language.observe(document.documentElement, { attributes: true, attributeFilter: ["lang"], subtree: true });
    this.#panel.onDetail = (fraction) => void this.#choose(this.#wantAt(fraction));
    this.#panel.onChoose = (want) => void this.#choose(want);
    this.#size.observe(this.#panel.view);
    this.#begin();
  }

  disconnectedCallback(): void {
    this.#language.disconnect();
    this.#size.disconnect();
    this.#near.disconnect();
    this.#clear();
  }

  attributeChangedCallback(name: string, before: string | null, value: string | null): void {
    if (name === "alt") this.#panel.alt = value ?? "";
    else if (name === "poster") this.#panel.poster = value;
    else if (!this.isConnected || before === value) return;
    else if (["src", "transport", "loading"].includes(name)) this.#begin();
    else if (this.#isPainted) this.#obey(name);
  }

  /** Applies an attribute that has changed while a model is shown. */
  #obey(name: string): void {
    const stage = this.#stage as Stage;
    if (kCamera.includes(name)) stage.frame(this.#camera);
    else if (kAmounts.includes(name)) void this.#sharpen();
    else if (name === "reveal") this.#reveal();
    else this.#move(stage);
  }

  /** Loads the model now or, if `loading` is lazy, when the element comes near the viewport. */
  #begin(): void {
    this.#near.disconnect();
    this.#clear();
    if (this.getAttribute("loading") === "lazy") this.#near.observe(this);
    else void this.#load();
  }

  /**
   * Applies properties that the page set before the element was defined. Such properties would otherwise hide the
   * accessors.
   */
  #adopt(): void {
    for (const name of ["src", "poster", "alt", "token"] as const) {
      if (!Object.hasOwn(this, name)) continue;
      const value = this[name];
      delete (this as Partial<typeof this>)[name];
      this[name] = value;
    }
  }

  async #load(): Promise<void> {
    this.#near.disconnect();
    const src = this.getAttribute("src");
    if (!src) return;
    const load = this.#loads;
    try {
      this.#model = new RemoteModel(src, this.#transport, assetsBeside(import.meta.url), this.#token);
      // Loads everything in parallel: the model and its decoder, the texts, the stage, and three.js, which the stage imports.
      const [{ Stage }] = await Promise.all([import("./stage.ts"), import("three"), this.#spoken]);
      if (load !== this.#loads) return;
      const stage = this.#open(new Stage(this.#panel.newCanvas(), this.#model));
      await stage.mesh.ready;
      if (load !== this.#loads) return;
      await this.#firstPaint(stage);
      if (load !== this.#loads) return;
      this.#isPainted = true;
      this.#reveal();
      this.#emit("first-paint");
      this.#equip(stage).catch(() => undefined); // the browser reports a failure; the model is then shown without tools
      await this.#sharpen();
    } catch (error) {
      if (load === this.#loads) this.#fail(error as Error);
    }
  }

  #open(stage: Stage): Stage {
    this.#stage = stage;
    stage.onCamera = (byVisitor) => {
      this.#emit("camera-change", { source: byVisitor ? "user-interaction" : "none" });
      this.#follow();
    };
    stage.mesh.addEventListener("stalled", ({ reason }) => (this.#panel.message = reason ?? ""));
    stage.mesh.addEventListener("error", ({ error }) => this.#isPainted && this.#fail(error));
    stage.mesh.addEventListener("progress", ({ bytes, total }) => this.#progress(bytes, total));
    stage.mesh.addEventListener("refine", ({ surface }) => this.#show(surface));
    return stage;
  }

  async #firstPaint(stage: Stage): Promise<void> {
    this.#fit();
    stage.frame(this.#camera);
    this.#move(stage);
    this.#panel.enable(stage.mesh.info);
    await stage.draw();
  }

  /**
   * Loads the texts in the element's language, unless they are already loaded. Called again when the language may have
   * changed.
   */
  #speak(): void {
    const spoken = textsFor(this);
    if (spoken === this.#spoken) return;
    this.#spoken = spoken;
    // If the texts cannot be loaded, loading the model fails and reports the error.
    spoken.then((texts) => spoken === this.#spoken && this.#say(texts)).catch(() => undefined);
  }

  #say(texts: ViewerTexts): void {
    this.#panel.texts = this.#texts = texts;
    this.#tools?.remove();
    this.#tools = undefined;
    if (this.#stage && this.#isPainted) this.#equip(this.#stage).catch(() => undefined);
  }

  /** Loads the visitor's tools after the first paint. */
  async #equip(stage: Stage): Promise<void> {
    const { Toolbox } = await import("./tools/toolbox.ts");
    if (stage !== this.#stage || !this.#texts) return;
    this.#tools ??= new Toolbox(this, this.#panel, this.#texts);
    this.#tools.attach(stage, { frame: () => stage.frame(this.#camera), sharpen: () => void this.#sharpen() });
  }

  #reveal(): void {
    if (this.getAttribute("reveal") !== "manual") this.#panel.hidePoster();
  }

  /** Applies the attributes that let the visitor or the auto-rotation move the camera. */
  #move(stage: Stage): void {
    stage.control(this.hasAttribute("camera-controls"), this.getAttribute("touch-action") ?? "pan-y");
    stage.isTurning = this.hasAttribute("auto-rotate") && !matchMedia("(prefers-reduced-motion: reduce)").matches;
  }

  get #camera(): CameraWords {
    const [orbit, target, fieldOfView] = kCamera.map((name) => this.getAttribute(name));
    return { orbit: orbit ?? null, target: target ?? null, fieldOfView: fieldOfView ?? null };
  }

  /** Refines to the detail that the attributes request. */
  #sharpen(): Promise<void> {
    this.#hasChosen = false;
    const goal = this.#goal();
    return this.#reach((stage) => (goal ? stage.mesh.refine(goal) : stage.refine(this.#pixels)));
  }

  /**
   * If the camera determines the detail, requests detail for the new view after kLook ms. Later movements within kLook
   * share the request.
   */
  #follow(): void {
    if (!this.#isPainted || this.#hasChosen || this.#goal()) return;
    this.#looking ??= setTimeout(() => {
      this.#looking = undefined;
      if (!this.#hasChosen) void this.#sharpen();
    }, kLook);
  }

  /** Refines to the visitor's choice of detail, which stays in force when the camera moves. */
  #choose(want: Want): Promise<void> {
    this.#hasChosen = true;
    return this.#reach((stage) => stage.mesh.refine(want));
  }

  async #reach(refine: (stage: Stage) => Promise<boolean>): Promise<void> {
    const stage = this.#stage;
    if (!stage) return;
    this.#panel.choice.begin();
    try {
      if (!(await refine(stage)) || stage !== this.#stage) return;
      await stage.still();
      if (stage !== this.#stage) return;
      this.#panel.progress = 1;
      this.#emit("load");
    } catch (error) {
      if (!(error instanceof ModelError)) throw error; // the mesh's "error" event reports ModelErrors
    }
  }

  #show(surface: { triangles: number; vertices: number; bytes: number }): void {
    this.#panel.choice.show(surface, this.#hasChosen || this.#goal() !== undefined);
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
    if (!this.#stage) this.#model?.close();
    this.#panel.message = this.#stage ? error.message : [this.#texts?.noWebGl, error.message].join(" ");
    this.#emit("error", { message: error.message });
  }

  #clear(): void {
    ++this.#loads;
    clearTimeout(this.#looking);
    this.#looking = undefined;
    this.#hasChosen = false;
    this.#tools?.detach();
    this.#stage?.dispose();
    this.#stage = undefined;
    this.#model?.close();
    this.#model = undefined;
    this.#isPainted = false;
    this.#panel.reset();
  }

  get #transport(): Transport {
    const value = this.getAttribute("transport");
    return value === "http" || value === "ws" ? value : "auto";
  }

  #number(name: string): number {
    return Number.parseFloat(this.getAttribute(name) ?? "");
  }

  /** Acceptable screen-space error in device pixels; 0 requests the whole model. */
  get #pixels(): number {
    const pixels = this.#number("pixel-error");
    return pixels >= 0 ? pixels : 1;
  }

  /** Returns the fixed state that the attributes request, or undefined if the camera determines the detail. */
  #goal(): Want | undefined {
    const triangles = this.#number("max-triangles"), bytes = this.#number("max-bytes"), error = this.#number("target-error");
    if (triangles >= 0) return { triangles };
    if (bytes >= 0) return { bytes };
    if (error >= 0) return { error };
    return this.#pixels > 0 ? undefined : { level: this.#info.levels.length - 1 };
  }

  /** Converts a slider position from 0 to 1 to a detail request. The slider is logarithmic in the triangle count. */
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
