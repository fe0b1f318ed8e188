// SPDX-License-Identifier: Apache-2.0
// The words of camera-orbit, camera-target and field-of-view, as model-viewer has them.

/** Where a camera stands: around the upright axis, down from it (radians), and how far from its target (model units). */
export interface Orbit {
  theta: number;
  phi: number;
  radius: number;
}

export type Point = [number, number, number];

const kMetres: Record<string, number> = { m: 1, cm: 0.01, mm: 0.001, in: 0.0254 };
const kRadians: Record<string, number> = { rad: 1, deg: Math.PI / 180 };

/** "30deg 75deg 105%". What is `auto`, left out or no such word is as in `framed`, of which % is a part. */
export function orbitOf(words: string | null, framed: Orbit, unit: string): Orbit {
  const [theta, phi, radius] = split(words);
  return {
    theta: angle(theta) ?? framed.theta,
    phi: angle(phi) ?? framed.phi,
    radius: (radius?.endsWith("%") ? (number(radius, "%") ?? NaN) / 100 * framed.radius : length(radius, unit)) || framed.radius,
  };
}

/** "0.1m 0m 20mm", in model coordinates; `auto` is the middle of the model. */
export function targetOf(words: string | null, centre: Point, unit: string): Point {
  const parts = split(words);
  return centre.map((middle, axis) => length(parts[axis], unit) ?? middle) as Point;
}

/** "30deg" as degrees, between 1 and 120. */
export function fieldOfViewOf(words: string | null, otherwise: number): number {
  const radians = angle(split(words)[0]);
  return radians === undefined ? otherwise : Math.min(Math.max(radians / (kRadians.deg as number), 1), 120);
}

function split(words: string | null): string[] {
  return (words ?? "").trim().split(/\s+/);
}

function number(word: string, suffix: string): number | undefined {
  const value = word.endsWith(suffix) ? Number(word.slice(0, word.length - suffix.length) || NaN) : NaN;
  return Number.isFinite(value) ? value : undefined;
}

function angle(word: string | undefined): number | undefined {
  const [, value, unit] = /^(.*?)(rad|deg)$/.exec(word ?? "") ?? [];
  return scaled(value, kRadians[unit ?? ""]);
}

/** In model units; a model without a unit is taken for one in metres. */
function length(word: string | undefined, unit: string): number | undefined {
  const [, value, given] = /^(.*?)(mm|cm|m)$/.exec(word ?? "") ?? [];
  return scaled(value, (kMetres[given ?? ""] ?? NaN) / (kMetres[unit] ?? 1));
}

function scaled(value: string | undefined, factor: number | undefined): number | undefined {
  const result = Number(value || NaN) * (factor ?? NaN);
  return Number.isFinite(result) ? result : undefined;
}
