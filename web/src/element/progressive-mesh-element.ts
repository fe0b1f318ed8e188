// SPDX-License-Identifier: Apache-2.0
// The custom element <progressive-mesh>.
import { assetsWith, type Assets } from "../core/assets.ts";
import { RemoteModel } from "../core/client.ts";
import type { Transport } from "../core/source.ts";
import { ModelError, type Level, type Want } from "../core/types.ts";
import { textsFor, type ViewerTexts } from "../texts/index.ts";
import type { ProgressiveMeshElementEventMap } from "./element-types.ts";
import { Panel } from "./panel.ts";
import type { CameraWords, Stage } from "./stage.ts";
import type { ToneWords } from "./tones.ts";
import type { Presenter } from "./tools/presenter.ts";
import type { Toolbox } from "./tools/toolbox.ts";

/** Milliseconds between two detail requests while the camera moves. */
const kLook = 200;

const kCamera = ["camera-orbit", "camera-target", "field-of-view"];
// A server has no HTMLElement, but imports this module when it renders a page that contains the element.
const Base: typeof HTMLElement = globalThis.HTMLElement ?? class {};

const kTones = ["tone-mapping", "exposure"];
const kAmounts = ["max-triangles", "max-bytes", "target-error", "pixel-error"];

/**
 * Shows one model and refines it. All attributes may change at any time; those without a description work
 * as in model-viewer:
 * - `src` (the URL of a .pmesh file, a model page or an API model), `poster` and `alt`, which are also properties;
 * - `loading` (eager, or lazy: loads when near the viewport), `reveal` (auto, or manual: the poster stays until dismissPoster());
 * - `camera-controls`, `touch-action` (pan-y), `camera-orbit`, `camera-target`, `field-of-view`, `auto-rotate`;
 * - `tone-mapping` (neutral, aces, agx, reinhard, cineon, linear or none), `exposure`, `shadow-intensity` (0 to 1, default 0);
 * - `pixel-error` (default 1): fetches what the camera sees, to an error of this many device pixels, and continues as the camera
 *   moves; 0 fetches the whole model. One of `max-triangles`, `max-bytes` and `target-error` (model units) requests a fixed state instead;
 * - `max-texture`: the largest side, in pixels, of a picture that is fetched;
 * - `ar`: offers augmented reality on phones;
 * - `transport` (auto, http or ws).
 * Events: `first-paint` (the base mesh is on the screen, no enhancement layer has been requested
 * yet), `progress` {bytes, total}, `refine` {triangles, vertices, bytes} for each state shown,
 * `picture` {side, texels, bytes} for each picture shown, `memory` {geometry, pictures} (bytes of graphics memory),
 * `load` (the requested detail is reached), `error` {message}, `camera-change` {source},
 * `tour-step` {step, steps}.
 */
export class ProgressiveMeshElement extends Base {
  static readonly observedAttributes = [
    "src", "poster", "alt", "transport", "loading", "reveal", "camera-controls", "touch-action", "auto-rotate", "max-texture", ...kCamera, ...kTones, ...kAmounts,
  ];

  readonly #panel = new Panel(this.attachShadow({ mode: "open" }));
  readonly #size = new ResizeObserver(() => this.#fit());
  readonly #language = new MutationObserver(() => this.#speak());
  readonly #near = new IntersectionObserver((seen) => seen.some(({ isIntersecting }) => isIntersecting) && void this.#load(), { rootMargin: "50%" });
  #model: RemoteModel | undefined;
  #stage: Stage | undefined;
  // Whether the base mesh is on the screen. Refinement and the visitor's tools start only then.
  #isPainted = false;
  #context: WebGL2RenderingContext | null = null;
  #loads = 0;
  #looking: ReturnType<typeof setTimeout> | undefined;
  // Whether the visitor has chosen a detail. Camera movements do not change a chosen detail.
  #hasChosen = false;
  #spoken: Promise<ViewerTexts> | undefined; // texts in the element's language
  #texts: ViewerTexts | undefined;
  #token = "";
  #assets: Partial<Assets> = {};
  #tools: Toolbox | undefined;

  /**
   * Token that is sent to the daemon for a model that is not public. It is not an attribute,
   * because a page's HTML may be copied and stored.
   */
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

  /**
   * Sets the URLs of viewer files that are neither in the module's folder nor where a bundler has put them.
   * Then loads the model again. All models of a page share one worker and its decoders, so the URLs set for
   * the first model apply to all.
   */
  setAssets(assets: Partial<Assets>): void {
    this.#assets = assets;
    if (this.isConnected) this.#begin();
  }

  /** The camera's position: angles in radians, and the distance from the target in model units. */
  getCameraOrbit(): { theta: number; phi: number; radius: number } | undefined {
    return this.#isPainted ? this.#stage?.orbit : undefined;
  }

  /** The point that the camera looks at, in the coordinates of the model as the daemon presents it (rotated and scaled). */
  getCameraTarget(): [number, number, number] | undefined {
    return this.#isPainted ? this.#stage?.target : undefined;
  }

  /** The vertical field of view, in degrees. */
  getFieldOfView(): number | undefined {
    return this.#isPainted ? this.#stage?.fieldOfView : undefined;
  }

  /** The functions with which the console edits how the model is presented. Undefined until the visitor's tools are loaded. */
  get presenter(): Presenter | undefined {
    return this.#isPainted ? this.#tools?.presenter : undefined;
  }

  /**
   * Hides the poster if `reveal` is manual. If the base mesh is not on the screen yet, hides the
   * poster as soon as it is.
   */
  dismissPoster(): void {
    if (this.#isPainted) this.#panel.hidePoster();
    else this.setAttribute("reveal", "auto");
  }

  connectedCallback(): void {
    this.#adopt();
    this.#panel.onDetail = (fraction) => void this.#choose(this.#wantAt(fraction));
    this.#panel.onChoose = (want) => void this.#choose(want);
    this.#size.observe(this.#panel.view);
    this.#begin();
    this.#speak();
    this.#language.observe(document.documentElement, { attributes: true, attributeFilter: ["lang"], subtree: true });
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
    else if (kTones.includes(name)) stage.tones = this.#tones;
    else if (kAmounts.includes(name)) void this.#sharpen();
    else if (name === "reveal") this.#reveal();
    else if (name === "max-texture") this.#limit(stage);
    else this.#move(stage);
  }

  /** Loads the model now. If `loading` is lazy, loads it when the element comes near the viewport. */
  #begin(): void {
    this.#near.disconnect();
    this.#clear();
    if (this.getAttribute("loading") === "lazy") this.#near.observe(this);
    else void this.#load();
  }

  /**
   * Applies properties that the page set before the element was defined. Otherwise, these properties of the
   * instance would hide the accessors of the class.
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
    // Requests three.js first. It is the largest file, so it should take the connection that is already open.
    const code = Promise.all([import("three"), import("./stage.ts")]);
    code.catch(() => undefined); // reported by the `await` below
    // Gives the script that has imported this module the chance to call setAssets before anything
    // is loaded.
    await Promise.resolve();
    if (load !== this.#loads) return;
    try {
      this.#model = new RemoteModel(src, this.#transport, assetsWith(this.#assets), this.#token);
      // Everything loads in parallel: the model and its decoder, the texts, the stage, and
      // three.js, which the stage uses.
      let [canvas, context] = this.#newContext(); // created while the code is being loaded
      const [[, { Stage }]] = await Promise.all([code, this.#spoken]);
      if (load !== this.#loads) return;
      if (context?.isContextLost()) [canvas, context] = this.#newContext();
      const stage = this.#open(new Stage(canvas, context, this.#model));
      await stage.mesh.ready;
      if (load !== this.#loads) return;
      await this.#firstPaint(stage);
      if (load !== this.#loads) return;
      this.#isPainted = true;
      this.#reveal();
      this.#emit("first-paint");
      // Ignores an error, because the browser reports it. The model is then shown without tools.
      this.#equip(stage).catch(() => undefined);
      // Ignores an error. In that case, lamp and sky light the model.
      if (stage.mesh.info.texture) stage.enterRoom().catch(() => undefined);
      await this.#sharpen();
    } catch (error) {
      if (load === this.#loads) this.#fail(error as Error);
    }
  }

  /** Makes a canvas and its context. The context keeps the drawing buffer after each frame, which printing and screenshots need. */
  #newContext(): [HTMLCanvasElement, WebGL2RenderingContext | null] {
    const canvas = this.#panel.newCanvas();
    const context = (this.#context = canvas.getContext("webgl2", { preserveDrawingBuffer: true }));
    return [canvas, context];
  }

  /**
   * Applies the attribute that limits the size of pictures. A picture that is already shown stays.
   */
  #limit(stage: Stage): void {
    const side = this.#number("max-texture");
    stage.mesh.maxTexture = side >= 0 ? side : Infinity;
    void stage.draw();
  }

  #open(stage: Stage): Stage {
    this.#stage = stage;
    this.#limit(stage);
    stage.onCamera = (byVisitor) => {
      this.#emit("camera-change", { source: byVisitor ? "user-interaction" : "none" });
      this.#follow();
    };
    stage.mesh.addEventListener("stalled", ({ reason }) => (this.#panel.message = reason ?? ""));
    stage.mesh.addEventListener("error", ({ error }) => this.#isPainted && this.#fail(error));
    stage.mesh.addEventListener("progress", ({ bytes, total }) => this.#progress(bytes, total));
    stage.mesh.addEventListener("refine", ({ surface }) => this.#show(surface));
    stage.mesh.addEventListener("memory", ({ geometry, pictures }) => this.#emit("memory", { geometry, pictures }));
    stage.mesh.addEventListener("picture", ({ side, texels, bytes }) => {
      this.#panel.choice.pictureBytes = bytes;
      this.#emit("picture", { side, texels, bytes });
    });
    return stage;
  }

  async #firstPaint(stage: Stage): Promise<void> {
    this.#fit();
    stage.frame(this.#camera);
    stage.tones = this.#tones;
    this.#move(stage);
    this.#panel.enable(stage.mesh.info);
    await stage.draw();
  }

  /**
   * Loads the texts in the element's language, unless they are already loaded. Called when the
   * language may have changed.
   */
  #speak(): void {
    const spoken = textsFor(this);
    if (spoken === this.#spoken) return;
    this.#spoken = spoken;
    // Ignores an error here, because loading the model fails with the same error and reports it.
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
    this.#tools.attach(stage, {
      frame: () => stage.frame(this.#camera),
      sharpen: () => void this.#sharpen(),
      choose: (triangles) => void this.#choose({ triangles }),
      hasChosen: () => this.#hasChosen,
    });
  }

  #reveal(): void {
    if (this.getAttribute("reveal") !== "manual") this.#panel.hidePoster();
  }

  /** Applies the attributes for camera movements by the visitor and by auto-rotation. */
  #move(stage: Stage): void {
    stage.control(this.hasAttribute("camera-controls"), this.getAttribute("touch-action") ?? "pan-y");
    stage.isTurning = this.hasAttribute("auto-rotate") && !matchMedia("(prefers-reduced-motion: reduce)").matches;
  }

  get #camera(): CameraWords {
    const [orbit, target, fieldOfView] = kCamera.map((name) => this.getAttribute(name));
    return { orbit: orbit ?? null, target: target ?? null, fieldOfView: fieldOfView ?? null };
  }

  get #tones(): ToneWords {
    const [mapping, exposure] = kTones.map((name) => this.getAttribute(name));
    return { mapping: mapping ?? null, exposure: exposure ?? null };
  }

  /** Refines to the detail that the attributes request. */
  #sharpen(): Promise<void> {
    this.#hasChosen = false;
    const goal = this.#goal();
    return this.#reach((stage) => (goal ? stage.mesh.refine(goal) : stage.refine(this.#pixels)));
  }

  /**
   * Requests detail for the new view after kLook ms, if the camera determines the detail. Further
   * movements within these kLook ms cause no further request.
   */
  #follow(): void {
    if (!this.#isPainted || this.#hasChosen || this.#goal()) return;
    this.#looking ??= setTimeout(() => {
      this.#looking = undefined;
      if (!this.#hasChosen) void this.#sharpen();
    }, kLook);
  }

  /** Refines to the detail that the visitor has chosen. Camera movements do not change this choice. */
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
      // Ignores a ModelError, because the mesh's "error" event reports it.
      if (!(error instanceof ModelError)) throw error;
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
    // The stage frees its context, because browsers allow only a few contexts per page. If there is no stage yet, frees the
    // context here.
    if (this.#stage) this.#stage.dispose();
    else this.#context?.getExtension("WEBGL_lose_context")?.loseContext();
    this.#stage = undefined;
    this.#context = null;
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

  /** Acceptable screen-space error, in device pixels. 0 requests the whole model. */
  get #pixels(): number {
    const pixels = this.#number("pixel-error");
    return pixels >= 0 ? pixels : 1;
  }

  /** Returns the fixed state that the attributes request. Returns undefined if the camera determines the detail. */
  #goal(): Want | undefined {
    const triangles = this.#number("max-triangles"), bytes = this.#number("max-bytes"), error = this.#number("target-error");
    if (triangles >= 0) return { triangles };
    if (bytes >= 0) return { bytes };
    if (error >= 0) return { error };
    return this.#pixels > 0 ? undefined : { level: this.#info.levels.length - 1 };
  }

  /**
   * Converts a slider position from 0 to 1 to a detail request. Positions are logarithmic in the
   * number of triangles.
   */
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

export interface ProgressiveMeshElement {
  addEventListener<K extends keyof ProgressiveMeshElementEventMap>(
    type: K, listener: (this: ProgressiveMeshElement, event: ProgressiveMeshElementEventMap[K]) => unknown, options?: boolean | AddEventListenerOptions,
  ): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject | null, options?: boolean | AddEventListenerOptions): void;
  removeEventListener<K extends keyof ProgressiveMeshElementEventMap>(
    type: K, listener: (this: ProgressiveMeshElement, event: ProgressiveMeshElementEventMap[K]) => unknown, options?: boolean | EventListenerOptions,
  ): void;
  removeEventListener(type: string, listener: EventListenerOrEventListenerObject | null, options?: boolean | EventListenerOptions): void;
}
