// SPDX-License-Identifier: Apache-2.0
import { environmentMap, kMapHeight, kMapWidth, kPlainHeight, kPlainWidth, plainMap } from "@element/room/environment-map.ts";
import { radiance } from "@element/room/radiance.ts";
import { DataUtils } from "three";

type Triple = [number, number, number];

/**
 * Indices of texels. A face of the sharpest level has 32 x 32 texels; `u` and `v` are positions in
 * the face, from 0 to 1. A face of a blurred level has 16 x 16 texels; blurred() returns the index
 * of the texel in the middle of the face.
 */
const sharp = (face: number, u = 0.5, v = 0.5) => texel(32 * (face % 3) + 1 + 30 * u, (face > 2 ? 32 : 0) + 1 + 30 * v);
const blurred = (level: number, face: number) => texel(48 * level + 16 * (face % 3) + 8, 64 + (face > 2 ? 16 : 0) + 8);
const texel = (x: number, y: number) => 4 * (Math.floor(y) * kMapWidth + Math.floor(x));
const at = (map: Uint16Array, index: number) => DataUtils.fromHalfFloat(map[index] as number);

describe("an environment map", () => {
  test("of even light is even at all levels, and grey", () => {
    const map = environmentMap(() => 5);
    const drawn = Array.from({ length: map.length / 4 }, (_, i) => [0, 1, 2, 3].map((channel) => at(map, 4 * i + channel))).filter(([, , , alpha]) => alpha === 1);
    expect(drawn.length).toBe(6 * (32 ** 2 + 16 ** 2 + 6 * 16 ** 2));
    for (const [red, green, blue] of drawn) {
      expect(red).toBeCloseTo(5, 2);
      expect([green, blue]).toEqual([red, red]);
    }
    expect(map.length).toBe(4 * kMapWidth * kMapHeight);
  });

  test("has its faces in the order +x, +y, +z, -x, -y, -z", () => {
    for (const axis of [0, 1, 2] as const) {
      const map = environmentMap((direction) => 2 + direction[axis]);
      for (let face = 0; face < 6; ++face) {
        expect(at(map, sharp(face))).toBeCloseTo(face === axis ? 3 : face === axis + 3 ? 1 : 2, 1);
      }
    }
  });

  test("has each face upright: u and v run as three.js expects", () => {
    const along: Triple[] = [[0, 0, 1], [-1, 0, 0], [-1, 0, 0], [0, 0, -1], [-1, 0, 0], [1, 0, 0]];
    along.forEach((axis, face) => {
      const map = environmentMap(([x, y, z]) => 2 + x * axis[0] + y * axis[1] + z * axis[2]);
      expect(at(map, sharp(face, 0.9))).toBeGreaterThan(at(map, sharp(face, 0.1)) + 0.5);
      expect(at(map, sharp(face, 0.5, 0.9))).toBeCloseTo(at(map, sharp(face, 0.5, 0.1)), 1);
    });
  });

  test("is blurred more and more, and keeps its mean", () => {
    const map = environmentMap(([, y]) => (y > 0.9 ? 8 : 0));
    const up = [1, 2, 3, 4, 5, 6].map((level) => at(map, blurred(level, 1)));
    for (let i = 1; i < up.length; ++i) expect(up[i]).toBeLessThan(up[i - 1] as number);
    expect(up[0]).toBeGreaterThan(7);
    expect(at(map, blurred(6, 4))).toBeLessThan(0.1);
  });
});

describe("a plain map", () => {
  test("has the directions of an equirectangular picture of three.js, from below to above", () => {
    const towards = (axis: number) => plainMap((direction) => 2 + (direction[axis] as number)), middle = kPlainHeight / 2;
    const texel = (map: Uint16Array, u: number, row: number) => at(map, 4 * (row * kPlainWidth + u * kPlainWidth));
    expect(texel(towards(1), 0.5, 0)).toBeCloseTo(1, 2);
    expect(texel(towards(1), 0.5, kPlainHeight - 1)).toBeCloseTo(3, 2);
    expect(texel(towards(0), 0.5, middle)).toBeCloseTo(3, 1);
    expect(texel(towards(0), 0, middle)).toBeCloseTo(1, 1);
    expect(texel(towards(2), 0.75, middle)).toBeCloseTo(3, 1);
    expect(texel(towards(2), 0.25, middle)).toBeCloseTo(1, 1);
  });
});

describe("the room", () => {
  const towards = (...vector: Triple) => radiance(vector.map((part) => part / Math.hypot(...vector)) as unknown as Triple);

  test("has panels that shine by themselves", () => {
    expect(towards(-14, 6.5, 8)).toBe(80);
    expect(towards(14, 8.5, 0)).toBe(23);
  });

  test("has white walls and boxes that the lamp lights", () => {
    // This direction hits the white floor below the eye. The lamp of intensity 400 is 15.05 above
    // the floor and displaced by 0.5 in x and in z.
    const far = Math.hypot(0.5, 15.05, 0.5), falloff = (1 - (far / 28) ** 4) ** 2 / far ** 2;
    expect(towards(0, -1, 0)).toBeCloseTo((400 * falloff * 15.05) / far / Math.PI, 6);
    expect(towards(-10.906, -4.5, 1.846)).toBeGreaterThan(0);
  });

  test("is lit everywhere, and brightest from above", () => {
    const all = Array.from({ length: 500 }, (_, i) => {
      const y = 1 - (2 * i + 1) / 500, turn = i * 2.39996, side = Math.sqrt(1 - y * y);
      return { y, light: radiance([side * Math.cos(turn), y, side * Math.sin(turn)]) };
    });
    const mean = (some: typeof all) => some.reduce((sum, { light }) => sum + light, 0) / some.length;
    expect(all.every(({ light }) => Number.isFinite(light) && light >= 0)).toBe(true);
    expect(mean(all.filter(({ y }) => y > 0))).toBeGreaterThan(1.5 * mean(all.filter(({ y }) => y < 0)));
  });
});
