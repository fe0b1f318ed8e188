// SPDX-License-Identifier: Apache-2.0
// Rotations as unit quaternions x, y, z, w.
export type Quaternion = [number, number, number, number];
export type Vector = [number, number, number];

/** Returns the rotation by `degrees` about `axis`, a unit vector, by the right-hand rule. */
export function turn(axis: Vector, degrees: number): Quaternion {
  const half = (degrees * Math.PI) / 360, sine = Math.sin(half);
  return [sine * axis[0], sine * axis[1], sine * axis[2], Math.cos(half)];
}

/** Returns the rotation that applies `first` and then `second`. Its length is 1, and its w is not negative. */
export function after(second: Quaternion, first: Quaternion): Quaternion {
  const [a, b, c, d] = second, [x, y, z, w] = first;
  const product = [d * x + a * w + b * z - c * y, d * y - a * z + b * w + c * x, d * z + a * y - b * x + c * w, d * w - a * x - b * y - c * z];
  const length = Math.hypot(...product) * (product[3]! < 0 ? -1 : 1);
  return product.map((part) => Number((part / length).toFixed(12)) + 0) as Quaternion;
}

/** The axes of a view, as unit vectors: to the right, upwards, and towards the eye. Angles are in degrees. */
export function viewAxes({ azimuth, elevation }: { azimuth: number; elevation: number }): { right: Vector; up: Vector; eye: Vector } {
  const a = (azimuth * Math.PI) / 180, e = (elevation * Math.PI) / 180;
  return {
    right: [Math.cos(a), 0, -Math.sin(a)],
    up: [-Math.sin(e) * Math.sin(a), Math.cos(e), -Math.sin(e) * Math.cos(a)],
    eye: [Math.cos(e) * Math.sin(a), Math.sin(e), Math.cos(e) * Math.cos(a)],
  };
}
