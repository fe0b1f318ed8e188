// SPDX-License-Identifier: Apache-2.0
// Couples the cameras of viewers. If the visitor moves one camera, the other viewers show their objects from the same direction,
// at the same size relative to their views, and with the same panning.
import type { Unit } from "../ui/api.ts";

export type Viewer = HTMLElement & {
  getCameraOrbit(): { theta: number; phi: number; radius: number } | undefined;
  getCameraTarget(): [number, number, number] | undefined;
};

/** The initial view, before the visitor has moved the camera. */
interface Home {
  /** Distance from the target, in model units. */
  radius: number;
  target: [number, number, number];
}

const kMetres: Record<Unit | "", number> = { mm: 0.001, cm: 0.01, m: 1, in: 0.0254, "": 1 };

export class Coupling {
  readonly #units = new Map<Viewer, Unit | "">();
  readonly #homes = new Map<Viewer, Home>();
  readonly #resized = new ResizeObserver(() => this.#goHome());

  /** Adds a viewer, or announces that a viewer will show another model. `unit` is the unit of the viewer's model. */
  set(viewer: Viewer, unit: Unit | ""): void {
    if (!this.#units.has(viewer)) this.#observe(viewer);
    this.#units.set(viewer, unit);
    this.#homes.delete(viewer);
  }

  #observe(viewer: Viewer): void {
    viewer.addEventListener("first-paint", () => this.#goHome());
    viewer.addEventListener("camera-change", (event) => {
      if ((event as CustomEvent<{ source: string }>).detail.source === "user-interaction") this.#follow(viewer);
    });
    this.#resized.observe(viewer);
  }

  /** Frames all objects, as seen from the front, because the distance that fits depends on the size of the view. */
  #goHome(): void {
    for (const viewer of this.#units.keys()) {
      if (!viewer.getCameraOrbit()) continue;
      // The viewer ignores an attribute that is set to its present value. Setting another value
      // first makes the viewer apply the second one.
      for (const orbit of ["auto auto 100%", "auto auto auto"]) viewer.setAttribute("camera-orbit", orbit);
      viewer.setAttribute("camera-target", "auto auto auto");
      const orbit = viewer.getCameraOrbit(), target = viewer.getCameraTarget();
      if (orbit && target) this.#homes.set(viewer, { radius: orbit.radius, target });
    }
  }

  #follow(leader: Viewer): void {
    const orbit = leader.getCameraOrbit(), target = leader.getCameraTarget(), from = this.#homes.get(leader);
    if (!orbit || !target || !from) return;
    for (const [viewer, home] of this.#homes) {
      if (viewer === leader) continue;
      const scale = home.radius / from.radius, metres = kMetres[this.#units.get(viewer) ?? ""];
      const moved = home.target.map((value, axis) => (value + scale * ((target[axis] ?? 0) - (from.target[axis] ?? 0))) * metres);
      viewer.setAttribute("camera-target", moved.map((value) => `${value}m`).join(" "));
      viewer.setAttribute("camera-orbit", `${orbit.theta}rad ${orbit.phi}rad ${(100 * orbit.radius) / from.radius}%`);
    }
  }
}
