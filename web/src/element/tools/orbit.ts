// SPDX-License-Identifier: Apache-2.0
// Moves the camera around the point that it looks at, either immediately or as an animation.
import { Vector3 } from "three";
import type { Stage } from "../stage.ts";
import { anglesOf, offsetOf, type OrbitView } from "./view.ts";

const kFlight = 600; // milliseconds of an animation

export class OrbitController {
  #flight = 0;

  constructor(private readonly stage: () => Stage) {}

  get view(): OrbitView {
    const { camera, controls } = this.stage().parts, { x, y, z } = this.stage().mesh.presentedCentre;
    const target = controls.target;
    return { ...anglesOf(camera.position.clone().sub(target)), target: [target.x + x, target.y + y, target.z + z] };
  }

  set view(view: OrbitView) {
    this.stop();
    this.#place(view);
  }

  /** Turns the camera by angles in degrees, and multiplies its distance by `zoom`. */
  turn(azimuth: number, elevation: number, zoom = 1): void {
    const { view } = this;
    this.view = { ...view, azimuth: view.azimuth + azimuth, elevation: view.elevation + elevation, distance: view.distance * zoom };
  }

  /** Moves the camera to the side of the target to which `direction` points. */
  flyTo(direction: Vector3): void {
    const { azimuth, elevation } = anglesOf(direction);
    this.fly({ ...this.view, azimuth, elevation });
  }

  /** Moves the camera to a view. Skips the animation if the visitor prefers reduced motion. */
  fly(to: OrbitView): void {
    const from = this.view, between = (a: number, b: number, part: number) => a + part * (b - a);
    const turn = ((((to.azimuth - from.azimuth) % 360) + 540) % 360) - 180;
    const at = (part: number): OrbitView => ({
      azimuth: from.azimuth + part * turn,
      elevation: between(from.elevation, to.elevation, part),
      distance: from.distance * (to.distance / from.distance) ** part,
      target: from.target.map((value, axis) => between(value, to.target[axis] as number, part)) as OrbitView["target"],
    });
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return void (this.view = at(1));
    this.stop();
    const begin = performance.now();
    const step = (now: number) => {
      const part = Math.min(1, Math.max(0, now - begin) / kFlight);
      this.#place(at(part * part * (3 - 2 * part)));
      this.#flight = part < 1 ? requestAnimationFrame(step) : 0;
    };
    this.#flight = requestAnimationFrame(step);
  }

  stop(): void {
    cancelAnimationFrame(this.#flight);
  }

  /** Places the camera, within the limits of the orbit controls. */
  #place(view: OrbitView): void {
    const { camera, controls } = this.stage().parts, { x, y, z } = this.stage().mesh.presentedCentre;
    controls.target.set(view.target[0] - x, view.target[1] - y, view.target[2] - z);
    const { x: right, y: up, z: front } = offsetOf({ ...view, elevation: Math.max(-89.9, Math.min(89.9, view.elevation)) });
    camera.position.set(right, up, front).add(controls.target);
    controls.update();
  }
}
