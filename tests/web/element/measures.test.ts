// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from "three";
import { csvOf, svgOf } from "@element/profile/profile.ts";
import { angleAt, areaOf } from "@element/tools/measures.ts";

const at = (x: number, y: number, z = 0) => new Vector3(x, y, z);

test.each([
  [at(1, 0), at(0, 2), 90], [at(1, 0), at(3, 0), 0], [at(1, 0), at(-1, 0), 180], [at(1, 1), at(1, 0), 45], [at(0, 0, 5), at(0, 3, 3), 45],
])("the angle between %o and %o is %s degrees", (one, other, angle) => {
  const corner = at(7, 8, 9);
  expect(angleAt(corner, one.clone().add(corner), other.clone().add(corner))).toBeCloseTo(angle);
});

test("a point in the corner makes no angle", () => expect(angleAt(at(1, 1), at(1, 1), at(2, 2))).toBeNaN());

test("the area of a polygon does not depend on its place, direction or sense", () => {
  const corners = [at(0, 0), at(4, 0), at(4, 3), at(2, 1), at(0, 3)];
  expect(areaOf(corners)).toBeCloseTo(8);
  expect(areaOf([...corners].reverse())).toBeCloseTo(8);
  const turned = corners.map((corner) => corner.clone().applyAxisAngle(at(1, 2, 3).normalize(), 1).add(at(100, -50, 20)));
  expect(areaOf(turned)).toBeCloseTo(8);
});

test("two points have no area", () => expect(areaOf([at(0, 0), at(1, 1)])).toBe(0));

const samples = [{ distance: 0.5, height: 0.25 }, { distance: 1.5, height: undefined }, { distance: 2.5, height: -0.125 }, { distance: 3.5, height: 0 }];

test("a profile is written with its unit, and gaps are empty", () => {
  expect(csvOf(samples, "mm")).toBe("distance [mm],height [mm]\r\n0.5,0.25\r\n1.5,\r\n2.5,-0.125\r\n3.5,0\r\n");
  expect(csvOf([], "")).toBe("distance,height\r\n");
});

test("a profile is drawn with gaps, and a unit is not markup", () => {
  const svg = svgOf(samples, (value) => `${value} <b>`);
  expect(svg.match(/d="(M[^"]*L[^"]*)"/)?.[1]?.match(/M/g)).toHaveLength(2);
  expect(svg).toContain("3.5 &#60;b&#62;");
  expect(svg).not.toContain("<b>");
});
