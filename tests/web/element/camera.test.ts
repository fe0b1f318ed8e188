// SPDX-License-Identifier: Apache-2.0
import { PerspectiveCamera, Vector3 } from "three";
import { fieldOfViewOf, orbitOf, targetOf } from "@element/camera.ts";
import { fittingDistance, kFieldOfView, kViewpoint } from "@element/viewpoint.ts";

const framed = { theta: 0.5, phi: 1.5, radius: 200 };
const degree = Math.PI / 180;

test.each([
  [null, framed],
  ["", framed],
  ["auto auto auto", framed],
  ["30deg 75deg 105%", { theta: 30 * degree, phi: 75 * degree, radius: 210 }],
  ["-1.5rad", { ...framed, theta: -1.5 }],
  ["0deg 90deg 0.1m", { theta: 0, phi: 90 * degree, radius: 100 }],
  ["auto auto 5cm", { ...framed, radius: 50 }],
  ["north high %", framed],
  ["auto auto 0m", framed],
])("camera-orbit %s", (words, expected) => {
  const orbit = orbitOf(words, framed, "mm");
  for (const part of ["theta", "phi", "radius"] as const) expect(orbit[part]).toBeCloseTo(expected[part], 9);
});

test.each([
  [null, "mm", [1, 2, 3]],
  ["auto 10mm auto", "mm", [1, 10, 3]],
  ["0.1m 0m 20mm", "mm", [100, 0, 20]],
  ["0.1m 0m 0m", "", [0.1, 0, 0]],
  ["0.0254m 0m 0m", "in", [1, 0, 0]],
])("camera-target %s of a model in %s", (words, unit, expected) => {
  const target = targetOf(words, [1, 2, 3], unit);
  target.forEach((value, axis) => expect(value).toBeCloseTo(expected[axis] as number, 9));
});

test.each([[null, 35], ["auto", 35], ["20deg", 20], ["1rad", 1 / degree], ["500deg", 120], ["0deg", 1]])(
  "field-of-view %s", (words, expected) => expect(fieldOfViewOf(words, 35)).toBeCloseTo(expected, 9));

describe("the distance that fits", () => {
  const shapes: Record<string, number[]> = {
    "a tall figure": [0, 5, 0, 0, -5, 0, 1, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, -1],
    "a plate": [3, 0, 0, -3, 0, 0, 0, 2, 0, 0, -2, 0],
    "a cube": [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-1, 1].flatMap((z) => [x, y, z]))),
    "a spear seen from its tip": [0, 0, 4, 0, 0, -4, 0, 0.1, 0, 0, -0.1, 0],
  };
  const cases = Object.keys(shapes).flatMap((name) => [0.5, 1, 1.8].map((aspect) => [name, aspect] as const));

  /**
   * Returns the largest distance of a vertex from the view's centre, horizontally or vertically.
   * The unit is half the view's width or height. The camera looks from `direction`.
   */
  function filled(positions: number[], direction: Vector3, distance: number, aspect: number): number {
    const camera = new PerspectiveCamera(kFieldOfView, aspect, 0.001, 1000);
    camera.position.copy(direction).setLength(distance);
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    let most = 0;
    for (let i = 0; i < positions.length; i += 3) {
      const { x, y } = new Vector3().fromArray(positions, i).project(camera);
      most = Math.max(most, Math.abs(x), Math.abs(y));
    }
    return most;
  }

  test.each(cases)("keeps %s in a view of aspect %s while it turns", (name, aspect) => {
    const shape = shapes[name] as number[], level = new Vector3(kViewpoint.x, 0, kViewpoint.z).normalize();
    const distance = fittingDistance(shape, new Vector3(), level, aspect);
    expect(filled(shape, level, distance, aspect)).toBeLessThan(0.8301);
    for (let turn = 0; turn < 360; turn += 5)
      expect(filled(shape, level.clone().applyAxisAngle(new Vector3(0, 1, 0), (turn * Math.PI) / 180), distance, aspect)).toBeLessThan(1.0001);
  });

  test.each([["a tall figure", 1.8], ["a plate", 0.5]])("lets %s fill a view of aspect %s", (name, aspect) => {
    const shape = shapes[name] as number[], distance = fittingDistance(shape, new Vector3(), kViewpoint, aspect);
    expect(filled(shape, kViewpoint, distance, aspect)).toBeGreaterThan(0.8);
  });
});
