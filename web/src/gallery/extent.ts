// SPDX-License-Identifier: Apache-2.0

/**
 * The upright cylinder about the table's axis that holds the points so far. Once the table has begun
 * to turn it grows but little, where a box would with each side that comes into sight: so a camera
 * that looks at it need not move.
 */
export class Extent {
  radius = 0;
  low = Infinity;
  high = -Infinity;

  /** Points with z upwards. */
  add(points: Float32Array): void {
    for (let i = 0; i + 2 < points.length; i += 3) {
      const z = points[i + 2] as number;
      this.radius = Math.max(this.radius, Math.hypot(points[i] as number, points[i + 1] as number));
      this.low = Math.min(this.low, z);
      this.high = Math.max(this.high, z);
    }
  }

  /** The height of its centre. */
  get middle(): number {
    return (this.low + this.high) / 2;
  }

  /** Of the sphere around it. */
  get reach(): number {
    return Math.hypot(this.radius, (this.high - this.low) / 2);
  }
}
