// SPDX-License-Identifier: Apache-2.0

/**
 * The upright cylinder around the turntable's axis that contains all points so far. The cylinder
 * hardly grows after the first side of the object has been measured, so the camera need not move. A
 * bounding box would grow with each side.
 */
export class Extent {
  radius = 0;
  low = Infinity;
  high = -Infinity;

  /** Adds points, given as x, y, z with z upwards. */
  add(points: Float32Array): void {
    for (let i = 0; i + 2 < points.length; i += 3) {
      const z = points[i + 2] as number;
      this.radius = Math.max(this.radius, Math.hypot(points[i] as number, points[i + 1] as number));
      this.low = Math.min(this.low, z);
      this.high = Math.max(this.high, z);
    }
  }

  /** Height of the cylinder's centre above the turntable. */
  get middle(): number {
    return (this.low + this.high) / 2;
  }

  /** Radius of the cylinder's bounding sphere. */
  get reach(): number {
    return Math.hypot(this.radius, (this.high - this.low) / 2);
  }
}
