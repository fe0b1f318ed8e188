// SPDX-License-Identifier: Apache-2.0
// Keeps HTML elements (marks) in front of points of the model while the camera moves.
import { Vector3, type PerspectiveCamera } from "three";

export interface Mark {
  element: HTMLElement;
  /** Position in the stage's scene: relative to the model's centre, in the unit of the presented model. */
  point: Vector3;
  /** Surface normal. If it points away from the camera, the mark gets the class `behind`. */
  normal?: Vector3;
}

export class Overlay {
  readonly #marks = new Set<Mark>();
  /** Functions called at each frame, after the marks have been placed. */
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

  /** Projects a point to the container. x and y are in CSS pixels from the container's upper left corner. */
  project(point: Vector3, camera: PerspectiveCamera): { x: number; y: number; isVisible: boolean } {
    const { x, y, z } = point.clone().project(camera);
    return { x: ((1 + x) / 2) * this.place.clientWidth, y: ((1 - y) / 2) * this.place.clientHeight, isVisible: z < 1 };
  }

  #put({ element, point, normal }: Mark, camera: PerspectiveCamera): void {
    const { x, y, isVisible } = this.project(point, camera);
    element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    element.classList.toggle("behind", !isVisible || (normal !== undefined && normal.dot(camera.position.clone().sub(point)) < 0));
  }
}
