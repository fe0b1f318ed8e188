// SPDX-License-Identifier: Apache-2.0
// The scene around one progressive mesh: camera, light, orbit controls. Draws only when something
// has changed.
import {
  Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene, Spherical, Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { ProgressiveMesh } from "../three/progressive-mesh.ts";
import type { RemoteModel } from "../core/client.ts";
import { fieldOfViewOf, orbitOf, targetOf, type Orbit, type Point } from "./camera.ts";
import { distanceFor, kFieldOfView, kViewpoint } from "./viewpoint.ts";

/** The attributes that say where the camera stands; null where there is none. */
export interface CameraWords {
  orbit: string | null;
  target: string | null;
  fieldOfView: string | null;
}

export class Stage {
  readonly mesh: ProgressiveMesh;
  /** Called after each change of the camera. */
  onCamera: (byVisitor: boolean) => void = () => undefined;
  /** Called after each picture. */
  onDraw: () => void = () => undefined;

  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(kFieldOfView, 1, 0.01, 100);
  readonly #controls: OrbitControls;
  readonly #lamp = new DirectionalLight(0xfffaf2, 2.2);
  readonly #wires: Mesh;
  #frame = 0;
  #placing = false;
  #turned = 0; // when the camera was last turned by itself
  #drawn: (() => void)[] = [];

  /** Throws where WebGL is missing. */
  constructor(canvas: HTMLCanvasElement, model: RemoteModel) {
    // What is drawn once must stay, for print and screenshots too.
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    // three.js sets its state up again when a lost context comes back, and leaves drawing to us.
    canvas.addEventListener("webglcontextrestored", () => void this.draw());
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.addEventListener("change", () => {
      this.draw();
      this.onCamera(!this.#placing);
    });
    this.mesh = new ProgressiveMesh(model);
    this.mesh.drawBy(this.#renderer);
    for (const type of ["refine", "morph"] as const) this.mesh.addEventListener(type, () => this.draw());
    this.#wires = new Mesh(this.mesh.geometry, new MeshBasicMaterial({ color: 0x1f4e5f, wireframe: true, transparent: true, opacity: 0.45 }));
    this.#wires.visible = false;
    this.mesh.morph(this.#wires.material as MeshBasicMaterial);
    this.#light();
    this.#scene.add(this.mesh, this.#wires, this.#camera);
  }

  /** What the visitor's tools work on (tools/toolbox.ts). */
  get parts() {
    return { renderer: this.#renderer, scene: this.#scene, camera: this.#camera, controls: this.#controls, lamp: this.#lamp };
  }

  /** Draws at the next frame; resolves when the picture has gone to the screen. */
  draw(): Promise<void> {
    const drawn = new Promise<void>((resolve) => this.#drawn.push(resolve));
    this.#frame ||= requestAnimationFrame(() => this.#render());
    return drawn;
  }

  /** Resolves when all vertices are in their places and the picture of them is on the screen. */
  async still(): Promise<void> {
    do await this.draw();
    while (this.mesh.morphing);
  }

  /** Refines what the camera sees to an error of so many pixels. */
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

  /** The camera looks at the whole model, or as the words say. */
  frame(words: CameraWords = { orbit: null, target: null, fieldOfView: null }): void {
    const { centre, unit } = this.mesh.info;
    const radius = this.mesh.geometry.boundingSphere?.radius ?? 1;
    this.#camera.fov = fieldOfViewOf(words.fieldOfView, kFieldOfView);
    const distance = distanceFor(radius, this.#camera.aspect, this.#camera.fov);
    this.#camera.near = radius / 100;
    this.#camera.far = distance + 20 * radius;
    this.#camera.updateProjectionMatrix();
    this.#controls.minDistance = radius * 0.2;
    this.#controls.maxDistance = 6 * distance;
    const around = new Spherical().setFromVector3(kViewpoint);
    const orbit = orbitOf(words.orbit, { theta: around.theta, phi: around.phi, radius: distance }, unit);
    this.#stand(orbit, targetOf(words.target, centre, unit));
  }

  /** Where the camera stands. */
  get orbit(): Orbit {
    const { theta, phi, radius } = new Spherical().setFromVector3(this.#camera.position.clone().sub(this.#controls.target));
    return { theta, phi, radius };
  }

  /** What it looks at, in model coordinates. */
  get target(): Point {
    return this.#controls.target.clone().add(new Vector3(...this.mesh.info.centre)).toArray();
  }

  /** Degrees, from bottom to top. */
  get fieldOfView(): number {
    return this.#camera.fov;
  }

  /** Whether the visitor may move the camera, and which gestures are left to the page: a value of CSS' touch-action. */
  control(on: boolean, touchAction: string): void {
    this.#controls.enabled = on;
    const { style } = this.#renderer.domElement;
    style.touchAction = on ? touchAction : "auto";
    style.cursor = on ? "" : "default";
  }

  /** The camera turns around the model by itself. */
  set turning(on: boolean) {
    this.#controls.autoRotate = on;
    this.#turned = performance.now();
    void this.draw();
  }

  #stand({ theta, phi, radius }: Orbit, target: Point): void {
    this.#controls.target.fromArray(target).sub(new Vector3(...this.mesh.info.centre));
    this.#camera.position.setFromSphericalCoords(radius, phi, theta).add(this.#controls.target);
    this.#placing = true;
    this.#controls.update();
    this.#placing = false;
    void this.draw();
  }

  set colours(on: boolean) {
    const { material, info } = this.mesh;
    material.vertexColors = on && info.coloured;
    material.color.set(material.vertexColors ? 0xffffff : 0xd8d3cb);
    material.needsUpdate = true;
    void this.draw();
  }

  /** Each facet by its own normal, as the printed figures of scanned surfaces show it. */
  set facets(on: boolean) {
    this.mesh.material.flatShading = on;
    this.mesh.material.needsUpdate = true;
    void this.draw();
  }

  set wireframe(on: boolean) {
    this.#wires.visible = on;
    this.mesh.material.polygonOffset = on;
    this.mesh.material.polygonOffsetFactor = this.mesh.material.polygonOffsetUnits = on ? 1 : 0;
    void this.draw();
  }

  dispose(): void {
    cancelAnimationFrame(this.#frame);
    this.#controls.dispose();
    (this.#wires.material as MeshBasicMaterial).dispose();
    this.mesh.dispose();
    this.#renderer.dispose();
    this.#renderer.forceContextLoss(); // browsers grant few contexts
  }

  #light(): void {
    this.#lamp.position.set(-0.6, 0.9, 0.6);
    this.#camera.add(this.#lamp, this.#lamp.target); // the light follows the visitor, whatever the model's size
    this.#scene.add(new HemisphereLight(new Color(0xffffff), new Color(0x8a8178), 1.1));
  }

  #render(): void {
    this.#frame = 0;
    if (this.#controls.autoRotate) this.#turn();
    this.#renderer.render(this.#scene, this.#camera);
    this.onDraw();
    const drawn = this.#drawn.splice(0);
    if (drawn.length !== 0) requestAnimationFrame(() => drawn.forEach((resolve) => resolve()));
  }

  #turn(): void {
    const now = performance.now();
    this.#placing = true;
    this.#controls.update((now - this.#turned) / 1000);
    this.#placing = false;
    this.#turned = now;
    void this.draw();
  }
}
