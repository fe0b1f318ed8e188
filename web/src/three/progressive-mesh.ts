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

/** Milliseconds per frame for uploading a change. */
const kFrameBudget = 2;

export interface ProgressiveMeshEventMap extends Object3DEventMap {
  /** Dispatched when the geometry has a new state of the surface, so that the page can draw again. */
  refine: { surface: Pick<Surface, "triangles" | "vertices" | "bytes"> };
  /** Dispatched when a geomorph has advanced, so that the page can draw again. */
  morph: object;
  progress: Progress;
  /** Dispatched with a reason when the server does not respond, and with undefined when it responds again. */
  stalled: { reason: string | undefined };
  error: { error: ModelError };
}

/**
 * A mesh that is refined in place. Its origin is the centre of the model's bounding box
 * (`info.centre` in model coordinates). Add it to a scene and call `refine` or, when the camera rests,
 * `refineFor`. Draw on `refine` and `morph` events or continuously. `dispose` frees everything.
 */
export class ProgressiveMesh extends Mesh<BufferGeometry, MeshStandardMaterial, ProgressiveMeshEventMap> {
  readonly #model: RemoteModel;
  readonly #geomorph = new Geomorph();
  #jobs: Steps[] = []; // uploads to GPU buffers, done one slice at a time
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
    // Double-sided, because scans are often open and show their inside.
    super(new BufferGeometry(), new MeshStandardMaterial({ color: 0xd8d3cb, roughness: 0.85, metalness: 0, side: DoubleSide }));
    this.morph(this.material);
    this.geometry.boundingSphere = new Sphere(); // empty until the base mesh is loaded
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

  /** The manifest; available after `ready`. */
  get info(): ModelInfo {
    if (!this.#info) throw new Error("wait for `ready` first");
    return this.#info;
  }

  /** Whether any vertices are moving in a geomorph. */
  get morphing(): boolean {
    return this.#moving !== 0;
  }

  /** Resolves to true when `want` is reached and in the geometry, to false if superseded. */
  refine(want: Want): Promise<boolean> {
    return this.#model.refine(want);
  }

  /**
   * Refines what `camera` sees in a viewport of `width` x `height` device pixels until no screen-space error exceeds
   * `pixels`, or the page's budget is spent. Regions outside the view do not change: call this again when the camera
   * has moved.
   */
  refineFor(camera: PerspectiveCamera, width: number, height: number, pixels = 1): Promise<boolean> {
    this.updateWorldMatrix(true, false);
    camera.updateWorldMatrix(true, false);
    const toModel = new Matrix4().makeTranslation(...this.info.centre).multiply(this.matrixWorld.clone().invert());
    const placed = toModel.multiply(camera.matrixWorld);
    return this.refine({ view: { camera: placed.toArray(), fov: camera.getEffectiveFOV(), width, height, pixels } });
  }

  /** Adds geomorphs to another material that draws this geometry. */
  morph(material: Material): void {
    this.#geomorph.apply(material);
  }

  /**
   * Sets the renderer that draws the mesh; there can be only one. Called automatically at the first frame if it
   * has not been called before; that frame then shows nothing.
   */
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
    if (this.#info) return; // already set if the decoder was restarted
    this.#info = info;
    const finest = info.levels[info.levels.length - 1];
    if (finest) this.#buffers = new SurfaceBuffers(this.geometry, finest, info.attributes);
    this.#attach();
    if (info.attributes.includes("colour")) {
      this.material.vertexColors = true;
      this.material.color.set(0xffffff);
    }
  }

  #accept(change: Change, shown: () => void): void {
    // If the decoder was restarted, the previous change may be incomplete and is dropped.
    if (this.#taking) this.#jobs = this.#jobs.filter((job) => job !== this.#taking);
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

  /** Runs jobs until the frame's budget is spent, a change is ready to be drawn, or data are missing. */
  #continue(): void {
    performance.mark("progressive-mesh:begin");
    const end = performance.now() + kFrameBudget;
    let pause: IteratorResult<"continue" | "next frame" | "wait", void> | undefined;
    for (let job = this.#jobs[0]; job && performance.now() < end; job = this.#jobs[0]) {
      pause = job.next();
      if (pause.done) this.#jobs.shift();
      else if (pause.value !== "continue") break;
    }
    this.#giveBack();
    performance.mark("progressive-mesh:end");
    // A performance trace has recorded the marks by now, so they need not stay in the page's memory.
    for (const mark of ["begin", "end"]) performance.clearMarks(`progressive-mesh:${mark}`);
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

  /**
   * Sets the bounds from the base mesh. The sphere's radius is half the diagonal of the box plus 10 %, because
   * refinement may add vertices outside the box.
   */
  #bound(): void {
    if (!this.#base) return;
    const box = new Box3().setFromArray(this.geometry.getAttribute("position").array);
    const centre = box.getCenter(new Vector3());
    this.geometry.boundingBox = box;
    this.geometry.boundingSphere = new Sphere(centre, 0.55 * box.getSize(new Vector3()).length());
  }
}
