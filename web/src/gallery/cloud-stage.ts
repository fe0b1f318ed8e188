// SPDX-License-Identifier: Apache-2.0
// The scene around a growing cloud of points. The camera follows its growth and circles it slowly
// until a visitor takes hold of it.
import { PerspectiveCamera, Scene, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { distanceFor, kFieldOfView, kViewpoint } from "../element/viewpoint.ts";
import { Cloud } from "./cloud.ts";
import { Extent } from "./extent.ts";

/** CSS pixels. */
const kPointSize = 1.5;
/** Minutes of a turn are 1 / kTurns. */
const kTurns = 1.2;
/** Seconds in which the camera makes up two thirds of what it lags behind. */
const kLag = 0.6;
/** Share of the way that is not worth another picture. */
const kNear = 1e-3;

export class CloudStage {
  readonly #cloud = new Cloud();
  #extent = new Extent();
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(kFieldOfView, 1, 0.1, 1000);
  readonly #controls: OrbitControls;
  #frame = 0;
  #before = 0; // time of the frame before
  #held = false; // by a visitor

  /** `still`: nothing moves by itself. Throws where WebGL is missing. */
  constructor(private readonly canvas: HTMLCanvasElement, private readonly still: boolean) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    canvas.addEventListener("webglcontextrestored", () => this.draw());
    this.#camera.position.copy(kViewpoint);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.autoRotate = !still;
    this.#controls.autoRotateSpeed = kTurns;
    this.#controls.addEventListener("start", () => this.#hold());
    this.#controls.addEventListener("change", () => this.draw());
    this.#scene.add(this.#cloud);
    this.restyle();
  }

  add(points: Float32Array): void {
    const first = this.#cloud.isEmpty;
    this.#extent.add(points);
    this.#cloud.append(points);
    if (first && !this.#held) this.#follow(1);
    this.draw();
  }

  /** For the points of a scan that measures again: a camera that a visitor holds stays. */
  restart(): void {
    this.#cloud.empty();
    this.#extent = new Extent();
    this.#renderer.clear();
  }

  /** Nothing more comes for now. */
  settle(): void {
    this.#cloud.settle();
    this.draw();
  }

  /** The page's colours, which change with the visitor's theme. */
  restyle(): void {
    const style = getComputedStyle(this.canvas);
    const colour = (name: string) => style.getPropertyValue(`--${name}`).trim();
    this.#cloud.paint({ ink: colour("ink"), accent: colour("accent") });
    this.draw();
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.#renderer.setSize(width, height, false);
    this.draw();
  }

  draw(): void {
    this.#frame ||= requestAnimationFrame((now) => this.#render(now));
  }

  dispose(): void {
    cancelAnimationFrame(this.#frame);
    this.#controls.dispose();
    this.#cloud.dispose();
    this.#renderer.dispose();
    this.#renderer.forceContextLoss(); // browsers grant few contexts
  }

  #hold(): void {
    this.#held = true;
    this.#controls.autoRotate = false;
  }

  #render(now: number): void {
    this.#frame = 0;
    const seconds = Math.min((now - this.#before) / 1000, 0.1); // a page that slept goes on where it was
    this.#before = now;
    if (this.#cloud.isEmpty) return;
    const moving = !this.#held && this.#follow(this.still ? 1 : 1 - Math.exp(-seconds / kLag));
    this.#controls.update(seconds);
    this.#dress();
    this.#renderer.render(this.#scene, this.#camera);
    if (moving || this.#controls.autoRotate) this.draw();
  }

  /** Goes `share` of the way to where all points are seen; false where it is there. */
  #follow(share: number): boolean {
    const { target } = this.#controls, offset = this.#camera.position.clone().sub(target);
    const wanted = distanceFor(this.#extent.reach, this.#camera.aspect);
    const away = wanted - offset.length(), up = this.#extent.middle - target.y;
    target.y += share * up;
    offset.setLength(offset.length() + share * away);
    this.#camera.position.copy(target).add(offset);
    this.#camera.near = wanted / 100;
    this.#camera.far = 10 * wanted;
    this.#camera.updateProjectionMatrix();
    return Math.abs(away) + Math.abs(up) > kNear * wanted;
  }

  #dress(): void {
    const { width, height } = this.canvas;
    this.#cloud.spread(kPointSize * this.#renderer.getPixelRatio(), width * height);
    const middle = this.#camera.position.distanceTo(this.#controls.target);
    this.#cloud.fade(middle - this.#extent.radius, middle + this.#extent.radius);
  }
}
