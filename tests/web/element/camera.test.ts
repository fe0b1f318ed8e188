// SPDX-License-Identifier: Apache-2.0
import { fieldOfViewOf, orbitOf, targetOf } from "@element/camera.ts";

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
