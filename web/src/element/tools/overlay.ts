// SPDX-License-Identifier: Apache-2.0
// Holds marks over points of the model while the camera moves.
import { Vector3, type PerspectiveCamera } from "three";

export interface Mark {
  element: HTMLElement;
  /** From the model's centre, as the mesh has it. */
  point: Vector3;
  /** Where the surface looks: a mark that it turns away is `behind`. */
  normal?: Vector3;
}

export class Overlay {
  readonly #marks = new Set<Mark>();
  /** Called with each picture, after the marks are placed. */
  readonly followers = new Set<() => void>();

  constructor(private readonly place: HTMLElement) {}

  add(mark: Mark): void {
    this.place.append(mark.element);
    this.#marks.add(mark);
  }

  remove(mark: Mark): void {
    mark.element.remove();
    this.#marks.delete(mark);
  }

  update(camera: PerspectiveCamera): void {
    for (const mark of this.#marks) this.#put(mark, camera);
    for (const follow of this.followers) follow();
  }

  /** Pixels from the place's upper left corner. */
  project(point: Vector3, camera: PerspectiveCamera): { x: number; y: number; visible: boolean } {
    const { x, y, z } = point.clone().project(camera);
    return { x: ((1 + x) / 2) * this.place.clientWidth, y: ((1 - y) / 2) * this.place.clientHeight, visible: z < 1 };
  }

  #put({ element, point, normal }: Mark, camera: PerspectiveCamera): void {
    const { x, y, visible } = this.project(point, camera);
    element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    element.classList.toggle("behind", !visible || (normal !== undefined && normal.dot(camera.position.clone().sub(point)) < 0));
  }
}
