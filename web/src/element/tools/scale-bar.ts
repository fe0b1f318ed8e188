// SPDX-License-Identifier: Apache-2.0
// A scale bar of a round length. It is correct only at the depth of the point that the camera looks at, because nearer
// parts look larger.
import type { PerspectiveCamera, Vector3 } from "three";
import type { Bench } from "./bench.ts";
import { make } from "./dom.ts";

const kLongest = 160; // greatest length of the bar, in CSS pixels

/**
 * Returns the largest number that is at most `most` and is 1, 2 or 5 times a power of ten. `most` must
 * be positive.
 */
export function roundLength(most: number): number {
  const power = 10 ** Math.floor(Math.log10(most));
  return ([5, 2].find((digit) => digit * power <= most) ?? 1) * power;
}

/** Returns how many pixels a length of 1 takes at the depth of `target`, in a view that is `height` pixels high. */
export function pixelsPerUnit(camera: PerspectiveCamera, target: Vector3, height: number): number {
  return height / (2 * Math.tan((camera.fov * Math.PI) / 360) * camera.position.distanceTo(target));
}

export class ScaleBar {
  readonly #bar = make("div", { class: "scale", hidden: true });

  constructor(private readonly bench: Bench) {
    bench.view.append(this.#bar);
    bench.overlay.followers.add(() => this.#draw());
  }

  set isShown(on: boolean) {
    this.#bar.hidden = !on;
    if (on) this.#draw();
  }

  #draw(): void {
    if (this.#bar.hidden) return;
    const { camera, controls } = this.bench.stage.parts, scale = pixelsPerUnit(camera, controls.target, this.bench.view.clientHeight);
    const length = roundLength(kLongest / scale);
    this.#bar.style.width = `${length * scale}px`;
    this.#bar.textContent = this.bench.texts.measured(length, this.bench.stage.mesh.info.unit);
  }
}
