// SPDX-License-Identifier: Apache-2.0
import {
  Box3, BufferGeometry, DoubleSide, Matrix4, Mesh, MeshStandardMaterial, Sphere, Vector3,
  type Material, type Object3DEventMap, type PerspectiveCamera, type WebGLRenderer,
} from "three";
import type { RemoteModel } from "../core/client.ts";
import type { Block, Change, ModelError, ModelInfo, Progress, Surface, Want } from "../core/types.ts";
import { Geomorph } from "./geomorph.ts";
import type { Steps } from "./gpu-array.ts";
import { SurfaceBuffers, type Inbox } from "./surface-buffers.ts";

/** Milliseconds of a frame that a change on its way into the buffers may take. */
const kFrameBudget = 2;

export interface ProgressiveMeshEventMap extends Object3DEventMap {
  /** Another state of the surface is in the geometry: draw again. */
  refine: { surface: Pick<Surface, "triangles" | "vertices" | "bytes"> };
  /** Vertices are on their way to their places: draw again. */
  morph: object;
  progress: Progress;
  /** The server does not answer, and why; undefined once it does again. */
  stalled: { reason: string | undefined };
  error: { error: ModelError };
}

/**
 * A mesh that sharpens in place. Its origin is the centre of the model's bounding box
 * (`info.centre` in model coordinates). Add it to a scene, call `refine` or, where the camera rests,
 * `refineFor`; draw on `refine` and `morph` events or all the time; `dispose` frees everything.
 */
export class ProgressiveMesh extends Mesh<BufferGeometry, MeshStandardMaterial, ProgressiveMeshEventMap> {
  readonly #model: RemoteModel;
  readonly #geomorph = new Geomorph();
  #jobs: Steps[] = []; // what goes into the buffers, a slice at a time
  #inbox: Inbox = { blocks: [], taken: [] };
  #taking: Steps | undefined;
  #buffers: SurfaceBuffers | undefined;
  #info: ModelInfo | undefined;
  #canvas: HTMLCanvasElement | undefined;
  #working = 0;
  #moving = 0;
  #base: { resolve(): void; reject(error: ModelError): void } | undefined;

  /** Resolves when the base mesh is in the geometry. */
  readonly ready: Promise<void>;

  constructor(model: RemoteModel) {
    // Scans are open as often as not: who looks into one sees its inside.
    super(new BufferGeometry(), new MeshStandardMaterial({ color: 0xd8d3cb, roughness: 0.85, metalness: 0, side: DoubleSide }));
    this.morph(this.material);
    this.geometry.boundingSphere = new Sphere(); // empty, until there is something
    this.ready = new Promise((resolve, reject) => (this.#base = { resolve, reject }));
    this.onBeforeRender = (renderer) => this.drawBy(renderer);
    this.#model = model;
    model.listener = {
      opened: (info) => this.#open(info),
      change: (change, shown) => this.#accept(change, shown),
      block: (block) => this.#receive(block),
      progress: (progress) => this.dispatchEvent({ type: "progress", ...progress }),
      stalled: (reason) => this.dispatchEvent({ type: "stalled", reason }),
      failed: (error) => this.#fail(error),
    };
  }

  /** The manifest; known once `ready`. */
  get info(): ModelInfo {
    if (!this.#info) throw new Error("wait for `ready` first");
    return this.#info;
  }

  /** Vertices are still on their way to their places. */
  get morphing(): boolean {
    return this.#moving !== 0;
  }

  /** True when `want` is reached and in the geometry, false when superseded. */
  refine(want: Want): Promise<boolean> {
    return this.#model.refine(want);
  }

  /**
   * Refines what `camera` sees in a viewport of `width` x `height` device pixels until no error there is above
   * `pixels`, or the page's budget is spent. What it does not see is left as it is: call this again when the camera
   * has moved.
   */
  refineFor(camera: PerspectiveCamera, width: number, height: number, pixels = 1): Promise<boolean> {
    this.updateWorldMatrix(true, false);
    camera.updateWorldMatrix(true, false);
    const toModel = new Matrix4().makeTranslation(...this.info.centre).multiply(this.matrixWorld.clone().invert());
    const placed = toModel.multiply(camera.matrixWorld);
    return this.refine({ view: { camera: placed.toArray(), fov: camera.getEffectiveFOV(), width, height, pixels } });
  }

  /** Makes another material that draws this geometry move along with it. */
  morph(material: Material): void {
    this.#geomorph.apply(material);
  }

  /** Draws by `renderer`, the only one. Called by itself at the first frame, which then shows nothing yet. */
  drawBy(renderer: WebGLRenderer): void {
    if (this.#canvas) return;
    this.#canvas = renderer.domElement;
    this.#canvas.addEventListener("webglcontextlost", this.#detach);
    this.#canvas.addEventListener("webglcontextrestored", this.#restore);
    this.#attach();
  }

  dispose(): void {
    cancelAnimationFrame(this.#working);
    cancelAnimationFrame(this.#moving);
    this.#jobs.length = 0;
    this.#model.close();
    this.#canvas?.removeEventListener("webglcontextlost", this.#detach);
    this.#canvas?.removeEventListener("webglcontextrestored", this.#restore);
    this.geometry.dispose();
    this.#buffers?.dispose();
    this.material.dispose();
    this.removeFromParent();
  }

  readonly #detach = () => this.#buffers?.detach();

  readonly #restore = () => this.#attach();

  #attach(): void {
    const gl = this.#canvas?.getContext("webgl2");
    if (gl && this.#buffers) this.#work(this.#attached(gl, this.#buffers));
  }

  #open(info: ModelInfo): void {
    if (this.#info) return; // its decoder has been started again
    this.#info = info;
    const finest = info.levels[info.levels.length - 1];
    if (finest) this.#buffers = new SurfaceBuffers(this.geometry, finest, info.coloured);
    this.#attach();
    if (info.coloured) {
      this.material.vertexColors = true;
      this.material.color.set(0xffffff);
    }
  }

  #accept(change: Change, shown: () => void): void {
    if (this.#taking) this.#jobs = this.#jobs.filter((job) => job !== this.#taking); // its decoder has been started again
    this.#inbox = { blocks: [], taken: [] };
    this.#work((this.#taking = this.#taken(change, this.#inbox, shown)));
  }

  #receive(block: Block): void {
    this.#inbox.blocks.push(block);
    this.#goOn();
  }

  *#attached(gl: WebGL2RenderingContext, buffers: SurfaceBuffers): Steps {
    yield* buffers.attach(gl);
    this.dispatchEvent({ type: "morph" });
  }

  *#taken(change: Change, inbox: Inbox, shown: () => void): Steps {
    const morph = !this.#base && !matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (this.#buffers) yield* this.#buffers.take(change, inbox, morph);
    this.#bound();
    if (morph) this.#move(change.number);
    const { triangles, vertices, bytes } = change;
    this.dispatchEvent({ type: "refine", surface: { triangles, vertices, bytes } });
    this.#base?.resolve();
    this.#base = undefined;
    requestAnimationFrame(shown);
  }

  #work(job: Steps): void {
    this.#jobs.push(job);
    this.#goOn();
  }

  #goOn(): void {
    this.#working ||= requestAnimationFrame(() => this.#continue());
  }

  /** Goes on until the frame's budget is spent, a change is drawn, or what is to come has not come yet. */
  #continue(): void {
    performance.mark("progressive-mesh:begin");
    const end = performance.now() + kFrameBudget;
    let pause: IteratorResult<"go on" | "next frame" | "wait", void> | undefined;
    for (let job = this.#jobs[0]; job && performance.now() < end; job = this.#jobs[0]) {
      pause = job.next();
      if (pause.done) this.#jobs.shift();
      else if (pause.value !== "go on") break;
    }
    this.#giveBack();
    performance.mark("progressive-mesh:end");
    for (const mark of ["begin", "end"]) performance.clearMarks(`progressive-mesh:${mark}`); // traces have them
    this.#working = 0;
    if (this.#jobs.length > 0 && pause?.value !== "wait") this.#goOn();
  }

  #giveBack(): void {
    const buffers = this.#inbox.taken.splice(0);
    if (buffers.length > 0) this.#model.giveBack(buffers);
  }

  #move(change: number): void {
    this.#geomorph.begin(change, performance.now());
    this.#moving ||= requestAnimationFrame(() => this.#advance());
  }

  #advance(): void {
    const moving = this.#geomorph.advance(performance.now());
    if (!moving) this.#buffers?.settle();
    this.#moving = moving ? requestAnimationFrame(() => this.#advance()) : 0;
    this.dispatchEvent({ type: "morph" });
  }

  #fail(error: ModelError): void {
    this.#base?.reject(error);
    this.#base = undefined;
    this.dispatchEvent({ type: "error", error });
  }

  /** The base mesh's box bounds all levels, but for what refinement adds: some slack. */
  #bound(): void {
    if (!this.#base) return;
    const box = new Box3().setFromArray(this.geometry.getAttribute("position").array);
    const centre = box.getCenter(new Vector3());
    this.geometry.boundingBox = box;
    this.geometry.boundingSphere = new Sphere(centre, 0.55 * box.getSize(new Vector3()).length());
  }
}
