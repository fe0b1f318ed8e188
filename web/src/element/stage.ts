// SPDX-License-Identifier: Apache-2.0
// The scene around one progressive mesh, with camera, light and orbit controls. It draws a frame
// only if something has changed.
import { BufferAttribute, BufferGeometry, Mesh, PerspectiveCamera, Scene, Spherical, Vector3, WebGLRenderer, type Texture } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { ProgressiveMesh } from "../three/progressive-mesh.ts";
import type { RemoteModel } from "../core/client.ts";
import type { PresentedView } from "../core/presentation.ts";
import { fieldOfViewOf, orbitOf, targetOf, type CameraOrbit, type Vec3 } from "./camera.ts";
import { Lights } from "./lights.ts";
import { tonesOf, type ToneWords } from "./tones.ts";
import { directionOf, fittingDistance, kFieldOfView, kViewpoint } from "./viewpoint.ts";

/** The attributes that place the camera. A missing attribute is null. */
export interface CameraWords {
  orbit: string | null;
  target: string | null;
  fieldOfView: string | null;
}

export class Stage {
  readonly mesh: ProgressiveMesh;
  /**
   * Called after each change of the camera. `byVisitor` is false if an attribute or the
   * auto-rotation moved the camera.
   */
  onCamera: (byVisitor: boolean) => void = () => undefined;
  /** Called after each frame. */
  onDraw: () => void = () => undefined;

  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(kFieldOfView, 1, 0.01, 100);
  readonly #controls: OrbitControls;
  readonly #lights = new Lights(this.#scene, this.#camera);
  #toneWords: ToneWords = { mapping: null, exposure: null };
  #frame = 0;
  #isPlacing = false;
  #room: Promise<void> | undefined;
  #turned = 0; // time of the last auto-rotation step, in milliseconds
  #drawn: (() => void)[] = [];
  #isDisposed = false;

  /** Draws to `context`. Throws if it is null, because WebGL is then not available. */
  constructor(canvas: HTMLCanvasElement, context: WebGL2RenderingContext | null, model: RemoteModel) {
    this.#renderer = new WebGLRenderer({ canvas, ...(context && { context }) });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    // Draws after a lost context is restored. three.js then restores its own state, but does not
    // draw.
    canvas.addEventListener("webglcontextrestored", () => void this.draw());
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.addEventListener("change", () => {
      this.draw();
      this.onCamera(!this.#isPlacing);
    });
    this.mesh = new ProgressiveMesh(model, this.#renderer);
    for (const type of ["refine", "morph", "picture"] as const) this.mesh.addEventListener(type, () => this.draw());
    this.#scene.add(this.mesh, this.#camera);
    if (!this.mesh.isOpen) this.#warmUp();
  }

  /**
   * Draws a triangle without area while the model is being loaded. Graphics drivers finish compiling a shader when it is
   * first used for drawing, which would delay the first picture. The triangle has the shader of a model without colours and
   * pictures.
   */
  #warmUp(): void {
    const triangle = new Mesh(new BufferGeometry(), this.mesh.material);
    triangle.frustumCulled = false;
    triangle.geometry.setAttribute("position", new BufferAttribute(new Float32Array(9), 3));
    triangle.geometry.setAttribute("normal", new BufferAttribute(new Int16Array(12), 4, true));
    triangle.geometry.setIndex(new BufferAttribute(new Uint32Array(3), 1));
    this.#scene.add(triangle);
    this.#renderer.render(this.#scene, this.#camera);
    this.#scene.remove(triangle);
    triangle.geometry.dispose();
  }

  /** The objects that the visitor's tools use (tools/toolbox.ts). */
  get parts() {
    return { renderer: this.#renderer, scene: this.#scene, camera: this.#camera, controls: this.#controls, lights: this.#lights };
  }

  /** Draws at the next animation frame. Resolves when that frame is on the screen. */
  draw(): Promise<void> {
    const drawn = new Promise<void>((resolve) => this.#drawn.push(resolve));
    this.#frame ||= requestAnimationFrame(() => this.#render());
    return drawn;
  }

  /** Resolves when all morphs have finished and the result is on the screen. */
  async still(): Promise<void> {
    do await this.draw();
    while (this.mesh.morphing);
  }

  /** Refines what the camera sees until no error exceeds `pixels` device pixels. */
  refine(pixels: number): Promise<boolean> {
    const { width, height } = this.#renderer.domElement;
    return this.mesh.refineFor(this.#camera, width, height, pixels);
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.#renderer.setSize(width, height, false);
    void this.draw();
  }

  /**
   * Places the camera as the attributes say. Without attributes, the model fills the view. Call this only once the base mesh is
   * shown, because the model's size is computed from the base mesh.
   */
  frame(words: CameraWords = { orbit: null, target: null, fieldOfView: null }): void {
    this.#place(words, this.mesh.info.presentation?.view);
  }

  /** Moves the camera to a view. Null stands for the usual first view. */
  show(view: PresentedView | null): void {
    this.#place({ orbit: null, target: null, fieldOfView: null }, view);
  }

  #place(words: CameraWords, view: PresentedView | null | undefined): void {
    const { info: { unit }, presentedCentre: centre } = this.mesh;
    const radius = this.radius;
    this.#camera.fov = fieldOfViewOf(words.fieldOfView, kFieldOfView);
    const around = new Spherical().setFromVector3(view ? directionOf(view) : kViewpoint);
    const target = targetOf(words.target, view?.target ?? centre.toArray(), unit);
    const distance = this.fittingDistance(new Vector3(...target).sub(centre), new Vector3().setFromSpherical(around));
    this.#camera.near = radius / 100;
    this.#camera.far = distance + 20 * radius;
    this.#camera.updateProjectionMatrix();
    this.#controls.minDistance = radius * 0.2;
    this.#controls.maxDistance = 6 * distance;
    this.#stand(orbitOf(words.orbit, { theta: around.theta, phi: around.phi, radius: distance / (view?.zoom ?? 1) }, unit), target);
  }

  /** Returns the distance from `target` at which the model fills the view. `target` is relative to the model's centre. */
  fittingDistance(target: Vector3, direction: Vector3): number {
    return fittingDistance(this.mesh.basePositions, target, direction, this.#camera.aspect, this.#camera.fov) || 1;
  }

  /** The radius of a sphere around the model, in the unit of the presented model. */
  get radius(): number {
    return (this.mesh.geometry.boundingSphere?.radius ?? 1) * this.mesh.scale.x;
  }

  /** The camera's position relative to the point that it looks at. */
  get orbit(): CameraOrbit {
    const { theta, phi, radius } = new Spherical().setFromVector3(this.#camera.position.clone().sub(this.#controls.target));
    return { theta, phi, radius };
  }

  /** The point that the camera looks at, in the coordinates of the presented (rotated and scaled) model. */
  get target(): Vec3 {
    return this.#controls.target.clone().add(this.mesh.presentedCentre).toArray();
  }

  /** The vertical field of view, in degrees. */
  get fieldOfView(): number {
    return this.#camera.fov;
  }

  /**
   * Sets whether the visitor may move the camera. `touchAction` is the CSS touch-action value: the
   * gestures that the page handles.
   */
  control(isEnabled: boolean, touchAction: string): void {
    this.#controls.enabled = isEnabled;
    const { style } = this.#renderer.domElement;
    style.touchAction = isEnabled ? touchAction : "auto";
    style.cursor = isEnabled ? "" : "default";
  }

  /** Whether the camera rotates around the model automatically. */
  get isTurning(): boolean {
    return this.#controls.autoRotate;
  }
  set isTurning(on: boolean) {
    this.#controls.autoRotate = on;
    this.#turned = performance.now();
    void this.draw();
  }

  #stand({ theta, phi, radius }: CameraOrbit, target: Vec3): void {
    this.#controls.target.fromArray(target).sub(this.mesh.presentedCentre);
    this.#camera.position.setFromSphericalCoords(radius, phi, theta).add(this.#controls.target);
    this.#isPlacing = true;
    this.#controls.update();
    this.#isPlacing = false;
    void this.draw();
  }

  /** Shows the form alone, without colours and pictures. */
  set form(on: boolean) {
    this.mesh.isBare = this.#lights.isRelief = on;
    this.#mapTones();
    void this.draw();
  }

  /**
   * Lights the model by a room, which metal and gloss reflect. Call this after the first picture, because it loads more code.
   * Further calls change nothing. Resolves when the next frame will show the room.
   */
  enterRoom(): Promise<void> {
    return (this.#room ??= this.#enterRoom());
  }

  async #enterRoom(): Promise<void> {
    await idle();
    const { roomEnvironment } = await import("./room/room.ts");
    const room = await roomEnvironment();
    if (this.#isDisposed) return;
    await this.#compileFor(room);
    if (this.#isDisposed) return room.dispose();
    this.#lights.enter(room, performance.now());
    void this.draw();
  }

  dispose(): void {
    this.#isDisposed = true;
    cancelAnimationFrame(this.#frame);
    this.#controls.dispose();
    this.mesh.dispose();
    this.#lights.dispose();
    this.#renderer.dispose();
    this.#renderer.forceContextLoss(); // browsers allow only a few contexts per page
  }

  /**
   * Sets the tone mapping that the attributes define. If only the form is shown, uses the tone mapping of untextured
   * models.
   */
  set tones(words: ToneWords) {
    this.#toneWords = words;
    this.#mapTones();
    void this.draw();
  }

  #mapTones(): void {
    const { mapping, exposure } = tonesOf(this.#toneWords, Boolean(this.mesh.info.texture) && !this.mesh.isBare);
    this.#renderer.toneMapping = mapping;
    this.#renderer.toneMappingExposure = exposure;
  }

  /** Compiles the shader that reflects `room` in the background, so that no frame waits for it. */
  async #compileFor(room: Texture): Promise<void> {
    this.#scene.environment = room;
    const compiled = this.#renderer.compileAsync(this.#scene, this.#camera);
    this.#scene.environment = null;
    await compiled;
  }

  #render(): void {
    this.#frame = 0;
    if (this.#controls.autoRotate) this.#turn();
    if (this.#lights.advance(performance.now())) void this.draw();
    this.#renderer.render(this.#scene, this.#camera);
    this.onDraw();
    const drawn = this.#drawn.splice(0);
    if (drawn.length !== 0) requestAnimationFrame(() => drawn.forEach((resolve) => resolve()));
  }

  #turn(): void {
    const now = performance.now();
    this.#isPlacing = true;
    this.#controls.update((now - this.#turned) / 1000);
    this.#isPlacing = false;
    this.#turned = now;
    void this.draw();
  }
}

/** Resolves when the page has nothing else to do. */
function idle(): Promise<void> {
  return new Promise((resolve) => ("requestIdleCallback" in window ? requestIdleCallback(() => resolve()) : setTimeout(resolve)));
}
