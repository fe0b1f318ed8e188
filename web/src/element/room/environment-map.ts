// SPDX-License-Identifier: Apache-2.0
// Computes a prefiltered environment map: the light from all directions, at levels of increasing
// blur. A shader needs only one access to the map to find the light that a surface of a given
// roughness reflects. The layout and the blurs are those of three.js (PMREMGenerator.js and
// cube_uv_reflection_fragment.glsl.js, revision 170), which calls the layout
// CubeUVReflectionMapping. Needs no GPU, so a worker can compute the map.

type Triple = [number, number, number];

/**
 * Sides in texels of the cube's faces at the levels without blur, including a border of one texel
 * on each side. The blurred levels have the smallest side.
 */
const kSides = [32, 16];
const kLargest = 32, kSmallest = 16;
/** The blur of each blurred level: standard deviation of the Gaussian, in radians. */
const kBlurs = [0.125, 0.215, 0.35, 0.446, 0.526, 0.582];
/**
 * Each texel of a level without blur, and each sample, is the mean of kRays x kRays rays. The rays
 * of a texel are spread over twice its width, which avoids jagged edges.
 */
const kRays = 4;
/** Side of the cube's faces in samples. The blurred levels are computed from these samples. */
const kSampleSide = 12;
/** Smallest number that a half float holds in full precision. */
const kSmallestHalf = 2 ** -14;

export const kMapWidth = 3 * kSmallest * (1 + kBlurs.length), kMapHeight = 4 * kLargest;

/**
 * Returns the map's RGBA texels as half floats. `radiance` returns the light, without colour, that arrives
 * from a direction (a unit vector).
 */
export function environmentMap(radiance: (direction: Triple) => number): Uint16Array<ArrayBuffer> {
  const map = new Uint16Array(4 * kMapWidth * kMapHeight);
  for (const side of kSides) {
    draw(map, side, 0, (face, u, v) => mean(kRays, (du, dv) => radiance(directionOf(face, u + (2 * du) / (side - 2), v + (2 * dv) / (side - 2)))));
  }
  const source = samples(radiance);
  kBlurs.forEach((blur, i) => draw(map, kSmallest, 3 * kSmallest * (i + 1), (face, u, v) => blurred(source, directionOf(face, u, v), blur)));
  return map;
}

export const kPlainWidth = 128, kPlainHeight = kPlainWidth / 2;

/**
 * Returns the RGBA texels, as half floats, of a map without blur in equirectangular projection. The first row is the lowest one, as
 * in a DataTexture of three.js.
 */
export function plainMap(radiance: (direction: Triple) => number): Uint16Array<ArrayBuffer> {
  const map = new Uint16Array(4 * kPlainWidth * kPlainHeight);
  for (let y = 0; y < kPlainHeight; ++y) {
    for (let x = 0; x < kPlainWidth; ++x) {
      const light = mean(kRays, (du, dv) => radiance(plainDirection((x + 0.5 + du) / kPlainWidth, (y + 0.5 + dv) / kPlainHeight)));
      const at = 4 * (y * kPlainWidth + x);
      map.fill(toHalf(light), at, at + 3);
      map[at + 3] = toHalf(1);
    }
  }
  return map;
}

/** Returns the direction of a point of an equirectangular map: the inverse of equirectUv() in three.js' shader common.glsl.js. */
function plainDirection(u: number, v: number): Triple {
  const around = 2 * Math.PI * (u - 0.5), up = Math.PI * (v - 0.5);
  return [Math.cos(up) * Math.cos(around), Math.sin(up), Math.cos(up) * Math.sin(around)];
}

/**
 * Draws the six faces of one level, in two rows, from column `left` on. `value` returns the light
 * at coordinates in a face: 0 to 1, and slightly outside of this range in the border.
 */
function draw(map: Uint16Array, side: number, left: number, value: (face: number, u: number, v: number) => number): void {
  const top = 4 * (kLargest - side);
  for (let y = 0; y < 2 * side; ++y) {
    for (let x = 0; x < 3 * side; ++x) {
      const face = Math.floor(x / side) + (y < side ? 0 : 3);
      const half = toHalf(value(face, ((x % side) - 0.5) / (side - 2), ((y % side) - 0.5) / (side - 2)));
      const at = 4 * ((top + y) * kMapWidth + left + x);
      map.fill(half, at, at + 3);
      map[at + 3] = toHalf(1);
    }
  }
}

/** Returns the direction of a point of a cube's face. Faces are in the order +x, +y, +z, -x, -y, -z. */
function directionOf(face: number, u: number, v: number): Triple {
  const a = 2 * u - 1, b = 2 * v - 1, length = Math.hypot(a, b, 1);
  const [x, y, z] = ([[1, b, a], [-a, 1, -b], [-a, b, 1], [-1, b, -a], [-a, -1, b], [a, b, -1]] as Triple[])[face] as Triple;
  return [x / length, y / length, z / length];
}

/** Returns the mean of `value` over a grid of `n` by `n` offsets from -0.5 to 0.5. */
function mean(n: number, value: (du: number, dv: number) => number): number {
  let sum = 0;
  for (let i = 0; i < n * n; ++i) sum += value(((i % n) + 0.5) / n - 0.5, (Math.floor(i / n) + 0.5) / n - 0.5);
  return sum / (n * n);
}

/**
 * Samples the light all over the sphere. Returns five numbers per sample: its direction (x, y, z),
 * its light, and its solid angle up to a constant factor.
 */
function samples(radiance: (direction: Triple) => number): Float64Array {
  const side = kSampleSide, all = [];
  for (let i = 0; i < 6 * side ** 2; ++i) {
    const face = Math.floor(i / side ** 2), u = ((i % side) + 0.5) / side, v = ((Math.floor(i / side) % side) + 0.5) / side;
    const light = mean(kRays, (du, dv) => radiance(directionOf(face, u + du / side, v + dv / side)));
    all.push(...directionOf(face, u, v), light, (1 + (2 * u - 1) ** 2 + (2 * v - 1) ** 2) ** -1.5);
  }
  return Float64Array.from(all);
}

/**
 * Returns the mean light around a direction, weighted by a Gaussian on the sphere (von Mises-Fisher
 * distribution). `blur` is the Gaussian's standard deviation in radians.
 */
function blurred(source: Float64Array, [x, y, z]: Triple, blur: number): number {
  let sum = 0, weights = 0;
  for (let i = 0; i < source.length; i += 5) {
    const at = (n: number) => source[i + n] as number;
    const weight = at(4) * Math.exp((x * at(0) + y * at(1) + z * at(2) - 1) / blur ** 2);
    sum += weight * at(3);
    weights += weight;
  }
  return sum / weights;
}

const float = new Float32Array(1), bits = new Uint32Array(float.buffer);

/**
 * Returns the half float nearest to a number from 0 to 65504. Numbers too small for full precision become
 * `kSmallestHalf`.
 */
function toHalf(value: number): number {
  float[0] = Math.max(value, kSmallestHalf);
  return ((bits[0] as number) - (112 << 23) + (1 << 12)) >> 13;
}
