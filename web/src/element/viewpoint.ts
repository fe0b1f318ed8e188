// SPDX-License-Identifier: Apache-2.0
// From where an object is seen at first: the same for a model and for the points it grows from.
import { Vector3 } from "three";

export const kFieldOfView = 35;
/** Where the camera stands, seen from the object's centre. */
export const kViewpoint = new Vector3(0.35, 0.15, 1).normalize();

/** How far from its centre a sphere is seen whole, but for a little that objects leave empty. */
export function distanceFor(radius: number, aspect: number, fieldOfView = kFieldOfView): number {
  const half = Math.atan(Math.tan((fieldOfView * Math.PI) / 360) * Math.min(1, aspect));
  return (radius * 0.9) / Math.sin(half);
}
