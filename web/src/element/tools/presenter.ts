// SPDX-License-Identifier: Apache-2.0
// Reads and previews how the model is presented, for the console.
import { Vector3 } from "three";
import type { Presentation, PresentedView } from "../../core/presentation.ts";
import type { Bench } from "./bench.ts";
import type { Light } from "./light.ts";
import type { NoteReader } from "../notes/note-reader.ts";
import type { Notes } from "./notes.ts";
import { pick } from "./pick.ts";

type Triple = [number, number, number];

export class Presenter {
  constructor(private readonly bench: Bench, private readonly light: Light, private readonly notes: Notes) {}

  /** Turns and scales the model at once. The camera sees it as large as before. */
  preview(placement: Pick<Presentation, "rotation" | "scale">): void {
    const { stage } = this.bench, { camera, controls } = stage.parts, ratio = placement.scale / stage.mesh.scale.x;
    stage.mesh.present(placement);
    this.notes.follow();
    controls.target.multiplyScalar(ratio);
    camera.position.multiplyScalar(ratio);
    for (const limit of ["minDistance", "maxDistance"] as const) controls[limit] *= ratio;
    for (const limit of ["near", "far"] as const) camera[limit] *= ratio;
    camera.updateProjectionMatrix();
    controls.update();
    void stage.draw();
  }

  /** Moves the camera to a view. Null stands for the usual first view. */
  show(view: PresentedView | null): void {
    this.bench.stage.show(view);
  }

  /** The present view and light. */
  get moment(): Pick<Presentation, "view" | "light"> {
    const { stage } = this.bench, { camera, controls: { target } } = stage.parts, { azimuth, elevation, distance } = this.bench.orbit.view;
    const fitting = stage.fittingDistance(target, camera.position.clone().sub(target).normalize());
    const zoom = Math.min(Math.max(fitting / distance, 0.1), 100), round = (value: number) => Number(value.toPrecision(6));
    const point = target.clone().add(stage.mesh.presentedCentre).toArray().map(round) as Triple;
    const degrees = (value: number) => Number(value.toFixed(3)) + 0;
    const view = { azimuth: degrees(azimuth), elevation: degrees(elevation), zoom: round(zoom), target: target.lengthSq() > 0 ? point : null };
    return { view, light: this.light.presented };
  }

  /** Loads the code that shows notes. */
  noteReader(): Promise<NoteReader> {
    return this.notes.reader();
  }

  /** The size along x, y and z of the model as it is presented (rotated and scaled). */
  get size(): Triple {
    return (this.bench.stage.mesh.presentedBox?.getSize(new Vector3()) ?? new Vector3()).toArray();
  }

  /** Returns the point of the presented (rotated and scaled) surface at a point of the window, or undefined if there is none. */
  pick(clientX: number, clientY: number): Triple | undefined {
    const { stage, view } = this.bench, { left, top } = view.getBoundingClientRect();
    return pick(stage, clientX - left, clientY - top)?.add(stage.mesh.presentedCentre).toArray();
  }

  /** Returns the place in the window, in pixels, where a point of the presented (rotated and scaled) model is seen. */
  project(point: Triple): [number, number] {
    const { stage, view, overlay } = this.bench, { left, top } = view.getBoundingClientRect();
    const { x, y } = overlay.project(new Vector3(...point).sub(stage.mesh.presentedCentre), stage.parts.camera);
    return [left + x, top + y];
  }
}
