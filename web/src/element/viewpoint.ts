// SPDX-License-Identifier: Apache-2.0
// The initial viewpoint. Its direction is the same for a model and for the point cloud of the model's scan.
import { Vector3 } from "three";

export const kFieldOfView = 35;
/** Direction from the object's centre to the camera. */
export const kViewpoint = new Vector3(0.35, 0.15, 1).normalize();

/** Returns the direction from the object's centre to the camera. Angles are in degrees. */
export function directionOf({ azimuth, elevation }: { azimuth: number; elevation: number }): Vector3 {
  return new Vector3().setFromSphericalCoords(1, ((90 - elevation) * Math.PI) / 180, (azimuth * Math.PI) / 180);
}

/** Part of the view's width or height, whichever is smaller, that a model fills at first. */
const kFill = 0.83;

/**
 * Returns the distance from the point `target` at which a camera sees all `positions` (x, y, z, ...) and they fill kFill of the
 * view. If the model then turns around the vertical axis through `target`, it still does not leave the view. `direction` is a unit
 * vector from the target to the camera; the other parameters are those of distanceFor().
 */
export function fittingDistance(positions: ArrayLike<number>, target: Vector3, direction: Vector3, aspect: number, fieldOfView = kFieldOfView): number {
  const rise = Math.tan((fieldOfView * Math.PI) / 360), run = rise * aspect, steep = Math.sin(Math.atan(run));
  const right = new Vector3(direction.z, 0, -direction.x).normalize(), up = direction.clone().cross(right);
  const p = new Vector3();
  let distance = 0;
  for (let i = 0; i + 2 < positions.length; i += 3) {
    p.fromArray(positions, i).sub(target);
    const seen = p.dot(direction) + Math.max(Math.abs(p.dot(right)) / run, Math.abs(p.dot(up)) / rise) / kFill;
    const round = Math.hypot(p.x, p.z), turned = Math.max(round + Math.abs(p.y) / rise, round / steep);
    distance = Math.max(distance, seen, turned);
  }
  return distance;
}

/**
 * Returns the distance from the camera at which a sphere fills the view. Uses 90 % of `radius`,
 * because an object rarely fills its bounding sphere. `aspect` is width / height. `fieldOfView` is
 * vertical, in degrees.
 */
export function distanceFor(radius: number, aspect: number, fieldOfView = kFieldOfView): number {
  const half = Math.atan(Math.tan((fieldOfView * Math.PI) / 360) * Math.min(1, aspect));
  return (radius * 0.9) / Math.sin(half);
}
