// SPDX-License-Identifier: Apache-2.0
// The initial viewpoint, which is the same for a model and for the point cloud of its scan.
import { Vector3 } from "three";

export const kFieldOfView = 35;
/** Direction from the object's centre to the camera. */
export const kViewpoint = new Vector3(0.35, 0.15, 1).normalize();

/**
 * Returns the distance from the camera to the centre of a sphere that fills the view. Assumes 90 % of `radius`, because
 * an object rarely fills its bounding sphere. `aspect` is width / height; `fieldOfView` is vertical, in degrees.
 */
export function distanceFor(radius: number, aspect: number, fieldOfView = kFieldOfView): number {
  const half = Math.atan(Math.tan((fieldOfView * Math.PI) / 360) * Math.min(1, aspect));
  return (radius * 0.9) / Math.sin(half);
}
