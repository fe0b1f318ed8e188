// SPDX-License-Identifier: Apache-2.0
// The scene around one progressive mesh, with camera, light and orbit controls. A frame is drawn only if something
// has changed.
import {
  Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene, Spherical, Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { ProgressiveMesh } from "../three/progressive-mesh.ts";
import type { RemoteModel } from "../core/client.ts";
import { fieldOfViewOf, orbitOf, targetOf, type CameraOrbit, type Vec3 } from "./camera.ts";
import { distanceFor, kFieldOfView, kViewpoint } from "./viewpoint.ts";

/** The attributes that place the camera; null for an attribute that is missing. */
export interface CameraWords {
  orbit: string | null;
  target: string | null;
  fieldOfView: string | null;
}

export class Stage {
  readonly mesh: ProgressiveMesh;
  /** Called after each change of the camera. `byVisitor` is false if an attribute or the auto-rotation moved it. */
  onCamera: (byVisitor: boolean) => void = () => undefined;
  /** Called after each frame. */
  onDraw: () => void = () => undefined;

  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(kFieldOfView, 1, 0.01, 100);
  readonly #controls: OrbitControls;
  readonly #lamp = new DirectionalLight(0xfffaf2, 2.2);
  readonly #wires: Mesh;
  #frame = 0;
  #isPlacing = false;
  #turned = 0; // time of the last auto-rotation step, in milliseconds
  #drawn: (() => void)[] = [];

  /** Throws if WebGL is not available. */
  constructor(canvas: HTMLCanvasElement, model: RemoteModel) {
    // The drawing buffer must be preserved for printing and screenshots.
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    // When a lost context is restored, three.js restores its state but does not draw.
    canvas.addEventListener("webglcontextrestored", () => void this.draw());
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.addEventListener("change", () => {
      this.draw();
      this.onCamera(!this.#isPlacing);
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

  /** The objects that the visitor's tools use (tools/toolbox.ts). */
  get parts() {
    return { renderer: this.#renderer, scene: this.#scene, camera: this.#camera, controls: this.#controls, lamp: this.#lamp };
  }

  /** Draws at the next frame; resolves when that frame is on the screen. */
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

  /** Refines what the camera sees to an error of this many device pixels. */
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

  /** Places the camera as the attributes say. Without attributes, the model fills the view. */
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

  /** The camera's position relative to the point that it looks at. */
  get orbit(): CameraOrbit {
    const { theta, phi, radius } = new Spherical().setFromVector3(this.#camera.position.clone().sub(this.#controls.target));
    return { theta, phi, radius };
  }

  /** The point that the camera looks at, in model coordinates. */
  get target(): Vec3 {
    return this.#controls.target.clone().add(new Vector3(...this.mesh.info.centre)).toArray();
  }

  /** The vertical field of view, degrees. */
  get fieldOfView(): number {
    return this.#camera.fov;
  }

  /** Sets whether the visitor may move the camera, and which gestures the page handles (a CSS touch-action value). */
  control(isEnabled: boolean, touchAction: string): void {
    this.#controls.enabled = isEnabled;
    const { style } = this.#renderer.domElement;
    style.touchAction = isEnabled ? touchAction : "auto";
    style.cursor = isEnabled ? "" : "default";
  }

  /** Sets whether the camera rotates around the model automatically. */
  set isTurning(on: boolean) {
    this.#controls.autoRotate = on;
    this.#turned = performance.now();
    void this.draw();
  }

  #stand({ theta, phi, radius }: CameraOrbit, target: Vec3): void {
    this.#controls.target.fromArray(target).sub(new Vector3(...this.mesh.info.centre));
    this.#camera.position.setFromSphericalCoords(radius, phi, theta).add(this.#controls.target);
    this.#isPlacing = true;
    this.#controls.update();
    this.#isPlacing = false;
    void this.draw();
  }

  set colours(on: boolean) {
    const { material, info } = this.mesh;
    material.vertexColors = on && info.attributes.includes("colour");
    material.color.set(material.vertexColors ? 0xffffff : 0xd8d3cb);
    material.needsUpdate = true;
    void this.draw();
  }

  /** Turns flat shading on or off. Printed figures of scanned surfaces often use it. */
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
    this.#renderer.forceContextLoss(); // browsers allow only a few contexts per page
  }

  #light(): void {
    this.#lamp.position.set(-0.6, 0.9, 0.6);
    this.#camera.add(this.#lamp, this.#lamp.target); // a directional light that follows the camera
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
    this.#isPlacing = true;
    this.#controls.update((now - this.#turned) / 1000);
    this.#isPlacing = false;
    this.#turned = now;
    void this.draw();
  }
}
