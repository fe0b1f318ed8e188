// SPDX-License-Identifier: Apache-2.0
import { Extent } from "@ui/extent.ts";

describe("Extent", () => {
  test("is the cylinder about the axis that holds all points", () => {
    const extent = new Extent();
    extent.add(new Float32Array([3, 4, 10, 0, -1, 34]));
    expect([extent.radius, extent.low, extent.high]).toEqual([5, 10, 34]);
    expect(extent.middle).toBe(22);
    expect(extent.reach).toBe(13);
  });

  test("does not move when the other side of the object comes into sight", () => {
    const extent = new Extent();
    extent.add(new Float32Array([20, 0, 0, 20, 0, 80]));
    const before = { middle: extent.middle, reach: extent.reach };
    extent.add(new Float32Array([-20, 0, 40, 0, 20, 60]));
    expect({ middle: extent.middle, reach: extent.reach }).toEqual(before);
  });
});
