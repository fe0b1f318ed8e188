// SPDX-License-Identifier: Apache-2.0
// Measures of points in space.
import { Vector3 } from "three";

/** Returns the angle at `corner` between the directions to two other points, in degrees. NaN if a point coincides with the corner. */
export function angleAt(corner: Vector3, one: Vector3, other: Vector3): number {
  const a = one.clone().sub(corner), b = other.clone().sub(corner);
  return (Math.atan2(a.clone().cross(b).length(), a.length() && b.length() ? a.dot(b) : NaN) * 180) / Math.PI;
}

/** Returns the area of the polygon with these corners, seen from the direction from which it looks largest. */
export function areaOf(corners: readonly Vector3[]): number {
  const sum = new Vector3(), first = corners[0] ?? sum;
  corners.forEach((corner, i) => {
    const next = corners[(i + 1) % corners.length] ?? first;
    sum.add(corner.clone().sub(first).cross(next.clone().sub(first)));
  });
  return sum.length() / 2;
}
