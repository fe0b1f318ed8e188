// SPDX-License-Identifier: Apache-2.0
import {
  Box3, DoubleSide, Matrix4, Mesh, MeshStandardMaterial, Vector3,
  type BufferGeometry, type Camera, type Material, type Object3DEventMap, type PerspectiveCamera, type WebGLRenderer,
} from "three";
import type { RemoteModel } from "../core/client.ts";
import type { Presentation } from "../core/presentation.ts";
import type { Block, Change, ModelError, ModelInfo, Progress, Surface, Want } from "../core/types.ts";
import { Appearance } from "./appearance.ts";
import { Geomorph } from "./geomorph.ts";
import type { Steps } from "./gpu-array.ts";
import { GpuPicture } from "./gpu-picture.ts";
import { Pictures } from "./pictures.ts";
import { sizeOnScreen } from "./size-on-screen.ts";
import { SurfaceBuffers, type Inbox } from "./surface-buffers.ts";
import { SurfaceGeometry } from "./surface-geometry.ts";

/** Milliseconds in each frame that may be spent on uploading a change. */
const kFrameBudget = 2;
/**
 * The level that the surface must reach before pictures finer than those in the file's head are
 * fetched.
 */
const kLevelBeforePictures = 2;

export interface ProgressiveMeshEventMap extends Object3DEventMap {
  /** Dispatched when the geometry has a new state of the surface. The page should then draw again. */
  refine: { surface: Pick<Surface, "triangles" | "vertices" | "bytes"> };
  /** Dispatched when a geomorph has advanced. The page should then draw again. */
  morph: object;
  /**
   * Dispatched when a picture is shown. The page should then draw again. `texels` is the total of
   * all pictures shown. `bytes` is the size of all pictures fetched, except those in the file's head.
   */
  picture: { side: number; texels: number; bytes: number };
  /** Dispatched when the graphics memory of the mesh has changed. `geometry` and `pictures` are in bytes. */
  memory: { geometry: number; pictures: number };
  progress: Progress;
  /** Dispatched with a reason when the server stops responding, and with undefined when it responds again. */
  stalled: { reason: string | undefined };
  error: { error: ModelError };
}

/**
 * A mesh that is refined in place. Its origin is the centre of the model's bounding box
 * (`info.centre` in model coordinates). It is turned and scaled as the daemon presents the model. Add the mesh to a scene, and call `refine`, or call
 * `refineFor` whenever the camera has come to rest. Draw on `refine` and `morph` events, or
 * continuously. `dispose` frees all memory.
 */
export class ProgressiveMesh extends Mesh<BufferGeometry, MeshStandardMaterial, ProgressiveMeshEventMap> {
  readonly #model: RemoteModel;
  readonly #geomorph = new Geomorph();
  readonly #appearance: Appearance;
  #pictures: Pictures | undefined;
  // Pictures that arrived while there was no WebGL context.
  #early: { index: number; bands: ImageBitmap[] }[] = [];
  #triangles = 0;
  #jobs: Steps[] = []; // uploads to GPU buffers, done one slice at a time
  #inbox: Inbox = { blocks: [], taken: [] };
  #taking: Steps | undefined;
  #buffers: SurfaceBuffers | undefined;
  #info: ModelInfo | undefined;
  #renderer: WebGLRenderer | undefined;
  #working = 0; // ID of the requested animation frame; -1 if the jobs continue without one; 0 if nothing is requested
  #moving = 0;
  #basePositions = new Float32Array(0); // relative to info.centre
  #base: { resolve(): void; reject(error: ModelError): void } | undefined;

  /** Largest side of a picture that is fetched for this mesh, in pixels. */
  maxTexture = Infinity;

  /** Resolves when the base mesh is in the geometry. */
  readonly ready: Promise<void>;

  /** Give the `renderer` if it is known, so that the first frame shows the mesh. */
  constructor(model: RemoteModel, renderer?: WebGLRenderer) {
    // Draws both sides of faces, because scans are often open and show their inside.
    super(new SurfaceGeometry(), new MeshStandardMaterial({ side: DoubleSide }));
    this.#appearance = new Appearance(this.material);
    this.morph(this.material);
    this.geometry.computeBoundingSphere(); // empty until the base mesh is loaded
    this.ready = new Promise((resolve, reject) => (this.#base = { resolve, reject }));
    this.onBeforeRender = (renderer, scene, camera) => {
      this.drawBy(renderer);
      // Scenes of three.js have no `environmentIntensity` before revision 163.
      this.#appearance.light(this.material.envMap ? this.material.envMapIntensity : scene.environment ? (scene.environmentIntensity ?? 1) : 0);
      this.#requestPicture(renderer, camera);
    };
    this.#model = model;
    if (renderer) this.drawBy(renderer);
    model.listener = {
      opened: (info) => this.#open(info),
      change: (change, shown) => this.#accept(change, shown),
      block: (block) => this.#receive(block),
      picture: (index, bands) => this.#acceptPicture(index, bands),
      progress: (progress) => this.dispatchEvent({ type: "progress", ...progress }),
      stalled: (reason) => this.dispatchEvent({ type: "stalled", reason }),
      failed: (error) => this.#fail(error),
    };
  }

  /** The manifest. Available when `ready` has resolved. */
  get info(): ModelInfo {
    if (!this.#info) throw new Error("wait for `ready` first");
    return this.#info;
  }

  /** Whether `info` is available. */
  get isOpen(): boolean {
    return this.#info !== undefined;
  }

  /** Whether the model has colours or pictures, which `isBare` hides. */
  get hasColours(): boolean {
    return this.#appearance.hasColours;
  }

  /** Whether only the form is shown, in one plain tone. */
  get isBare(): boolean {
    return this.#appearance.isBare;
  }
  set isBare(on: boolean) {
    this.#appearance.isBare = on;
  }

  /** Whether any vertices are moving in a geomorph. */
  get morphing(): boolean {
    return this.#moving !== 0;
  }

  /**
   * Resolves to true when `want` is reached and in the geometry. Resolves to false if a later
   * request replaces it.
   */
  refine(want: Want): Promise<boolean> {
    return this.#model.refine("error" in want ? { error: want.error / this.scale.x } : want);
  }

  /**
   * Refines what `camera` sees in a viewport of `width` x `height` device pixels. Stops when no
   * screen-space error exceeds `pixels`, or when the page's budget is spent. Does not change
   * regions outside the view, so call this again when the camera has moved.
   */
  refineFor(camera: PerspectiveCamera, width: number, height: number, pixels = 1): Promise<boolean> {
    this.updateWorldMatrix(true, false);
    camera.updateWorldMatrix(true, false);
    const toModel = new Matrix4().makeTranslation(...this.info.centre).multiply(this.matrixWorld.clone().invert());
    // The planner expects a camera without scaling.
    const placed = toModel.multiply(camera.matrixWorld).scale(new Vector3().setScalar(this.matrixWorld.getMaxScaleOnAxis()));
    return this.refine({ view: { camera: placed.toArray(), fov: camera.getEffectiveFOV(), width, height, pixels } });
  }

  /** Turns and scales the mesh as the daemon presents the model. Called when the model is opened. */
  present({ rotation, scale }: Pick<Presentation, "rotation" | "scale">): void {
    this.quaternion.fromArray(rotation);
    this.scale.setScalar(scale);
    this.updateMatrixWorld();
  }

  /** The mesh's origin (`info.centre`) in presented coordinates, which are those of exported files. */
  get presentedCentre(): Vector3 {
    return new Vector3(...this.info.centre).applyQuaternion(this.quaternion).multiply(this.scale);
  }

  /** The positions (x, y, z, ...) of the base mesh, relative to `presentedCentre`. Empty until the base mesh is loaded. */
  get basePositions(): Float32Array {
    const placed = new Float32Array(this.#basePositions.length), point = new Vector3();
    for (let i = 0; i < placed.length; i += 3)
      point.fromArray(this.#basePositions, i).applyQuaternion(this.quaternion).multiply(this.scale).toArray(placed, i);
    return placed;
  }

  /** The bounding box of the base mesh, relative to `presentedCentre`. Null until the base mesh is loaded. */
  get presentedBox(): Box3 | null {
    return this.geometry.boundingBox && new Box3().setFromArray(this.basePositions);
  }

  /** Adds geomorphs to another material that draws this geometry. */
  morph(material: Material): void {
    this.#geomorph.apply(material);
  }

  /**
   * Sets the renderer that draws the mesh. Later calls have no effect. If this function was not
   * called before the first frame, the first frame calls it and shows nothing.
   */
  drawBy(renderer: WebGLRenderer): void {
    if (this.#renderer) return;
    this.#renderer = renderer;
    renderer.domElement.addEventListener("webglcontextlost", this.#detach);
    renderer.domElement.addEventListener("webglcontextrestored", this.#restore);
    this.#acceptEarly();
    this.#attach();
  }

  /**
   * Returns a mesh that shares its geometry and material with this mesh, like the clones of other three.js meshes. The clone
   * is refined together with this mesh, until this mesh is disposed of.
   */
  override clone(recursive?: boolean): this {
    const copy = new Mesh(this.geometry, this.material).copy(this as Mesh<BufferGeometry, MeshStandardMaterial>, recursive);
    copy.onBeforeRender = this.onBeforeRender;
    return copy as unknown as this;
  }

  dispose(): void {
    cancelAnimationFrame(this.#working);
    cancelAnimationFrame(this.#moving);
    this.#jobs.length = 0;
    this.#model.close();
    this.#renderer?.domElement.removeEventListener("webglcontextlost", this.#detach);
    this.#renderer?.domElement.removeEventListener("webglcontextrestored", this.#restore);
    this.geometry.dispose();
    this.#buffers?.dispose();
    this.#appearance.dispose();
    this.removeFromParent();
  }

  readonly #detach = () => {
    this.#buffers?.detach();
    this.#appearance.forget();
    this.#pictures?.forget();
  };

  readonly #restore = () => {
    this.#attach();
    const { pictures = [], inHead } = this.#info?.texture ?? {};
    for (const [index, { side }] of pictures.slice(0, inHead).entries()) this.#model.showPicture({ index, side });
    this.#acceptEarly();
  };

  #attach(): void {
    const gl = this.#renderer?.getContext() as WebGL2RenderingContext | undefined;
    if (gl && this.#buffers) this.#work(this.#attached(gl, this.#buffers));
  }

  #open(info: ModelInfo): void {
    this.#pictures?.forgetRequest();
    if (this.#info) return; // already set, if the decoder was restarted
    this.#info = info;
    if (info.presentation) this.present(info.presentation);
    const finest = info.levels[info.levels.length - 1];
    if (finest) this.#buffers = new SurfaceBuffers(this.geometry, finest, info.attributes, info.texture !== undefined);
    if (info.texture) this.#pictures = new Pictures(info.texture);
    this.#appearance.info = info;
    this.#attach();
  }

  /**
   * Requests the picture that fits the size of the model as `camera` shows it, if this picture is
   * finer than the one shown.
   */
  #requestPicture(renderer: WebGLRenderer, camera: Camera): void {
    const levels = this.#info?.levels ?? [], box = this.geometry.boundingBox;
    const level = levels[Math.min(kLevelBeforePictures, levels.length - 1)];
    if (!this.#pictures || !box || !level || this.#triangles < level.faces) return;
    const pixels = sizeOnScreen(box, this.matrixWorld, camera, renderer.domElement.height);
    const next = this.#pictures.next(pixels, {
      side: Math.min(this.maxTexture, renderer.capabilities.maxTextureSize),
      texels: this.#model.roomForTexels,
      savesData: (navigator as { connection?: { saveData?: boolean } }).connection?.saveData === true,
    });
    if (next) this.#model.showPicture(next);
  }

  /**
   * Uploads the pictures that waited for a context. Uploads them before any surface, so that no surface is shown without its
   * pictures.
   */
  #acceptEarly(): void {
    const others = this.#jobs.splice(0);
    for (const { index, bands } of this.#early.splice(0)) this.#acceptPicture(index, bands);
    this.#jobs.push(...others);
  }

  #acceptPicture(index: number, bands: ImageBitmap[]): void {
    if (this.#renderer) this.#work(this.#showPicture(this.#renderer, index, bands));
    else this.#early.push({ index, bands });
  }

  /**
   * Uploads and shows a picture that has arrived, unless a picture of the same or finer detail is shown. If the WebGL
   * context is lost, keeps the picture until the context is restored. If the context is lost during the upload, the picture
   * is requested again.
   */
  *#showPicture(renderer: WebGLRenderer, index: number, bands: ImageBitmap[]): Steps {
    if (renderer.getContext().isContextLost()) return void this.#early.push({ index, bands });
    const pictures = this.#pictures, picture = { index, side: bands[0]?.width ?? 0 };
    const role = pictures?.receive(picture);
    if (!pictures || !role) return bands.forEach((band) => band.close());
    const image = new GpuPicture(renderer, picture.side, role === "colour" || role === "emission");
    yield* image.fill(bands);
    if (!image.isPresent) return pictures.forgetRequest(), image.texture.dispose();
    pictures.show(role, picture);
    this.#appearance.show(role, image.texture);
    const { texels, bytes } = pictures;
    this.#model.holdTexels(texels);
    this.dispatchEvent({ type: "picture", side: picture.side, texels, bytes });
    this.#tellMemory();
  }

  #tellMemory(): void {
    this.dispatchEvent({ type: "memory", geometry: this.#buffers?.bytes ?? 0, pictures: this.#pictures?.graphicsBytes ?? 0 });
  }

  #accept(change: Change, shown: () => void): void {
    // Drops the previous change, which may be incomplete if the decoder was restarted.
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
    this.#triangles = triangles;
    this.dispatchEvent({ type: "refine", surface: { triangles, vertices, bytes } });
    this.#tellMemory();
    this.#base?.resolve();
    this.#base = undefined;
    requestAnimationFrame(shown);
  }

  #work(job: Steps): void {
    this.#jobs.push(job);
    this.#goOn();
  }

  /**
   * Continues in the next frame. The base mesh is small, so its upload does not wait for the next frame. It waits only until the
   * current function ends, because this function may still add listeners.
   */
  #goOn(): void {
    if (this.#working !== 0) return;
    this.#working = this.#base ? -1 : requestAnimationFrame(() => this.#continue());
    if (this.#base) queueMicrotask(() => this.#continue());
  }

  /** Runs upload jobs until the frame's budget is spent, a change is ready to be drawn, or data are missing. */
  #continue(): void {
    performance.mark("progressive-mesh:begin");
    const end = performance.now() + kFrameBudget;
    let pause: IteratorResult<"continue" | "next frame" | "wait", void> | undefined;
    for (let job = this.#jobs[0]; job && (this.#base || performance.now() < end); job = this.#jobs[0]) {
      pause = job.next();
      if (pause.done) this.#jobs.shift();
      else if (pause.value === "wait" || (pause.value === "next frame" && !this.#base)) break;
    }
    this.#giveBack();
    performance.mark("progressive-mesh:end");
    // Removes the marks from the page's memory. A performance trace has recorded them by now.
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
    if (!moving && this.#buffers) {
      this.#buffers.settle();
      this.#tellMemory();
    }
    this.#moving = moving ? requestAnimationFrame(() => this.#advance()) : 0;
    this.dispatchEvent({ type: "morph" });
  }

  #fail(error: ModelError): void {
    this.#base?.reject(error);
    this.#base = undefined;
    this.dispatchEvent({ type: "error", error });
  }

  /** Sets the bounds from the base mesh. */
  #bound(): void {
    if (!this.#base) return;
    this.geometry.computeBoundingBox();
    this.geometry.computeBoundingSphere();
    this.#basePositions = Float32Array.from(this.geometry.getAttribute("position").array);
  }
}
