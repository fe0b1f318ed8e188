// SPDX-License-Identifier: Apache-2.0
import { Quaternion, Vector3 } from "three";
import { after, turn, viewAxes, type Vector } from "@console/rotation.ts";

const applied = (rotation: [number, number, number, number], vector: Vector) => new Vector3(...vector).applyQuaternion(new Quaternion(...rotation)).toArray();
const near = (vector: number[], expected: number[]) => vector.forEach((part, i) => expect(part).toBeCloseTo(expected[i] as number));

test("a turn follows the right-hand rule", () => {
  near(applied(turn([0, 0, 1], 90), [1, 0, 0]), [0, 1, 0]);
  near(applied(turn([1, 0, 0], -90), [0, 0, 1]), [0, 1, 0]);
});

test("turns are applied one after the other", () => {
  const both = after(turn([0, 0, 1], 90), turn([1, 0, 0], 90));
  near(applied(both, [0, 1, 0]), [0, 0, 1]);
  near(applied(both, [1, 0, 0]), [0, 1, 0]);
  expect(Math.hypot(...both)).toBeCloseTo(1, 10);
});

test("a turn and its opposite leave no trace, and four quarters neither", () => {
  const start: [number, number, number, number] = [0, 0, 0, 1];
  expect(after(turn([1, 0, 0], -90), after(turn([1, 0, 0], 90), start))).toEqual(start);
  let rotation = start;
  for (let i = 0; i < 4; ++i) rotation = after(turn([0, 1, 0], 90), rotation);
  near(rotation, start);
  expect(rotation[3]).toBeGreaterThan(0);
});

test.each([[0, 0], [90, 0], [30, 40], [-120, -70]])("the axes of a view from azimuth %s and elevation %s are orthonormal", (azimuth, elevation) => {
  const { right, up, eye } = viewAxes({ azimuth, elevation });
  near(new Vector3(...right).cross(new Vector3(...up)).toArray(), eye);
  expect(new Vector3(...right).dot(new Vector3(...up))).toBeCloseTo(0);
  expect(up[1]).toBeGreaterThan(0);
});
