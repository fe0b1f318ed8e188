// SPDX-License-Identifier: Apache-2.0
// The light in a small photo studio: a white room with a lamp at the ceiling, grey boxes and bright panels. Lamp, boxes and
// panels are those of the neutral environment of model-viewer (EnvironmentScene.ts, Apache-2.0, Google LLC), so that a
// model looks the same in both viewers.

type Triple = readonly [number, number, number];

/** A box turned about the vertical axis. A panel shines by itself; other boxes are white and lit by the lamp. */
interface Box {
  centre: Triple;
  size: Triple;
  /** Rotation in radians. */
  turn?: number;
  /** Radiance of a panel. */
  shine?: number;
}

/** The point in the room from which the light is seen. */
const kEye: Triple = [0, 3.5, 0];
const kLamp = { at: [0.5, 14, 0.5] as Triple, intensity: 400, reach: 28 };
const kWalls: Box = { centre: [0, 13.2, 0], size: [31.5, 28.5, 31.5] };
const kBoxes: readonly Box[] = [
  { centre: [-10.906, -1, 1.846], turn: -0.195, size: [2.328, 7.905, 4.651] },
  { centre: [-5.607, -0.754, -0.758], turn: 0.994, size: [1.97, 1.534, 3.955] },
  { centre: [6.167, -0.16, 7.803], turn: 0.561, size: [3.927, 6.285, 3.687] },
  { centre: [-2.017, 0.018, 6.124], turn: 0.333, size: [2.002, 4.566, 2.064] },
  { centre: [2.291, -0.756, -2.621], turn: -0.286, size: [1.546, 1.552, 1.496] },
  { centre: [-2.193, -0.369, -5.547], turn: 0.516, size: [3.875, 3.487, 2.986] },
  { centre: [-14, 10, 8], size: [0.1, 2.5, 2.5], shine: 80 },
  { centre: [-14, 14, -4], size: [0.1, 2.5, 2.5], shine: 80 },
  { centre: [14, 12, 0], size: [0.1, 5, 5], shine: 23 },
  { centre: [0, 9, 14], size: [5, 5, 0.1], shine: 16 },
  { centre: [7, 8, -14], size: [2.5, 2.5, 0.1], shine: 80 },
  { centre: [-7, 16, -14], size: [2.5, 2.5, 0.1], shine: 80 },
];

/**
 * A box, with the position of the eye in the box's coordinates, and the cosine and sine of the
 * box's rotation.
 */
interface Placed extends Box {
  eye: Triple;
  cosine: number;
  sine: number;
}

const kPlacedWalls = placed(kWalls), kPlacedBoxes = kBoxes.map(placed);

function placed(box: Box): Placed {
  const { centre, turn = 0 } = box, cosine = Math.cos(turn), sine = Math.sin(turn);
  const eye: Triple = [kEye[0] - centre[0], kEye[1] - centre[1], kEye[2] - centre[2]];
  return { ...box, cosine, sine, eye: inBox({ cosine, sine }, eye) };
}

/** Rotates a vector from the room's coordinates to those of a box. */
function inBox({ cosine, sine }: Pick<Placed, "cosine" | "sine">, [x, y, z]: Triple): Triple {
  return [cosine * x - sine * z, y, cosine * z + sine * x];
}

/** Returns the radiance, without colour, that arrives in the middle of the room from `direction`, a unit vector. */
export function radiance(direction: Triple): number {
  let distance = crossing(kPlacedWalls, direction, true), nearest = kPlacedWalls;
  for (const box of kPlacedBoxes) {
    const other = crossing(box, direction, false);
    if (other < distance) [distance, nearest] = [other, box];
  }
  return nearest.shine ?? reflected(nearest, direction, distance);
}

/**
 * Returns the distance at which a ray from the eye enters `box`, or at which it leaves `box` if
 * `isInside`. Returns infinity if the ray misses the box.
 */
function crossing({ size, eye, cosine, sine }: Placed, [x, y, z]: Triple, isInside: boolean): number {
  let enter = 0, leave = Infinity;
  for (let axis = 0; axis < 3; ++axis) {
    const along = axis === 0 ? cosine * x - sine * z : axis === 1 ? y : cosine * z + sine * x;
    const half = (size[axis] as number) / 2, from = eye[axis] as number;
    const one = (-half - from) / along, other = (half - from) / along;
    enter = Math.max(enter, Math.min(one, other));
    leave = Math.min(leave, Math.max(one, other));
  }
  if (isInside) return leave;
  return enter > 0 && enter < leave ? enter : Infinity;
}

/**
 * Returns the radiance of a white, matt surface that the lamp lights, without shadows. `distance`
 * is the distance of the surface from the eye. Light decreases with distance as in three.js.
 */
function reflected(box: Placed, direction: Triple, distance: number): number {
  const along = inBox(box, direction);
  const share = ([0, 1, 2] as const).map((i) => Math.abs(box.eye[i] + distance * along[i]) / box.size[i]);
  // Axis perpendicular to the side of the box that contains the point. Along this axis, the point's
  // distance from the box's centre is largest, relative to the box's size.
  const axis = share.indexOf(Math.max(...share)) as 0 | 1 | 2;
  const toLamp: Triple = [kLamp.at[0] - kEye[0] - distance * direction[0], kLamp.at[1] - kEye[1] - distance * direction[1], kLamp.at[2] - kEye[2] - distance * direction[2]];
  const far = Math.hypot(...toLamp);
  // The side of the box that the eye sees is lit only if the lamp is on the same side.
  const cosine = (-Math.sign(along[axis]) * inBox(box, toLamp)[axis]) / far;
  const falloff = Math.max(0, 1 - (far / kLamp.reach) ** 4) ** 2 / far ** 2;
  return (Math.max(0, cosine) * kLamp.intensity * falloff) / Math.PI;
}
