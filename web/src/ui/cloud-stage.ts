// SPDX-License-Identifier: Apache-2.0
// The scene around a growing point cloud. The camera keeps the whole cloud in view and circles it
// slowly, until a visitor takes control of the camera.
import { PerspectiveCamera, Scene, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { distanceFor, kFieldOfView, kViewpoint } from "../element/viewpoint.ts";
import { Cloud } from "./cloud.ts";
import { Extent } from "./extent.ts";

/** Size of a point, in CSS pixels. */
const kPointSize = 1.5;
/** Revolutions of the camera per minute. */
const kTurns = 1.2;
/** Seconds in which the camera covers about two thirds (1 - 1/e) of the distance to its goal. */
const kLag = 0.6;
/** The camera stops moving when its distance to the goal is below this fraction of the viewing distance. */
const kNear = 1e-3;

export class CloudStage {
  readonly #cloud = new Cloud();
  #extent = new Extent();
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(kFieldOfView, 1, 0.1, 1000);
  readonly #controls: OrbitControls;
  #frame = 0;
  #before = 0; // time of the previous frame, in milliseconds
  #isHeld = false; // whether a visitor has taken control of the camera

  /** If `isStill` is true, the camera does not move by itself. Throws if WebGL is not available. */
  constructor(private readonly canvas: HTMLCanvasElement, private readonly isStill: boolean) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    canvas.addEventListener("webglcontextrestored", () => this.draw());
    this.#camera.position.copy(kViewpoint);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.autoRotate = !isStill;
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
    if (first && !this.#isHeld) this.#follow(1);
    this.draw();
  }

  /**
   * Removes all points. Called when the scan has started again from the beginning. If a visitor controls the camera, the camera
   * stays in place.
   */
  restart(): void {
    this.#cloud.empty();
    this.#extent = new Extent();
    this.#renderer.clear();
  }

  /** Called when no more points are expected for now. Stops highlighting the newest points. */
  settle(): void {
    this.#cloud.settle();
    this.draw();
  }

  /** Applies the page's colours, which depend on the visitor's colour scheme. */
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
    this.#renderer.forceContextLoss(); // browsers allow only a few contexts per page
  }

  #hold(): void {
    this.#isHeld = true;
    this.#controls.autoRotate = false;
  }

  #render(now: number): void {
    this.#frame = 0;
    // Time since the previous frame, but at most 0.1 s, even if the page was in the background.
    const seconds = Math.min((now - this.#before) / 1000, 0.1);
    this.#before = now;
    if (this.#cloud.isEmpty) return;
    const moving = !this.#isHeld && this.#follow(this.isStill ? 1 : 1 - Math.exp(-seconds / kLag));
    this.#controls.update(seconds);
    this.#dress();
    this.#renderer.render(this.#scene, this.#camera);
    if (moving || this.#controls.autoRotate) this.draw();
  }

  /**
   * Moves the camera towards its goal, by the fraction `share` of the distance. The goal is the
   * position from which the camera sees all points. Returns false if the camera is already at its goal.
   */
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
