// SPDX-License-Identifier: Apache-2.0
import { Vector3, type Box3, type Camera, type Matrix4 } from "three";

/**
 * Returns the size in pixels of the longest side of `box`, at the point of the box that is nearest
 * to the camera. `placement` is the matrix from the box's to world coordinates, `height` the height
 * of the drawing in pixels. For a camera inside the box, the result is Infinity.
 */
export function sizeOnScreen(box: Box3, placement: Matrix4, camera: Camera, height: number): number {
  const size = box.getSize(new Vector3()), longest = Math.max(size.x, size.y, size.z) * placement.getMaxScaleOnAxis();
  const { elements } = camera.projectionMatrix, scale = ((elements[5] ?? 1) * height) / 2;
  const isPerspective = elements[11] === -1;
  if (!isPerspective) return longest * scale;
  const eye = camera.getWorldPosition(new Vector3()).applyMatrix4(placement.clone().invert());
  const distance = box.distanceToPoint(eye) * placement.getMaxScaleOnAxis();
  return distance > 0 ? (longest * scale) / distance : Infinity;
}
