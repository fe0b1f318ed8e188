// SPDX-License-Identifier: Apache-2.0
// Parses the attributes camera-orbit, camera-target and field-of-view, in the syntax of
// model-viewer.

/**
 * A camera position in spherical coordinates: azimuth theta and polar angle phi in radians, and the
 * distance from the target in model units.
 */
export interface CameraOrbit {
  theta: number;
  phi: number;
  radius: number;
}

export type Vec3 = [number, number, number];

const kMetres: Record<string, number> = { m: 1, cm: 0.01, mm: 0.001, in: 0.0254 };
const kRadians: Record<string, number> = { rad: 1, deg: Math.PI / 180 };

/**
 * Parses a camera position such as "30deg 75deg 105%". Parts that are `auto`, missing or malformed
 * are taken from `framed`. A percentage is relative to the radius of `framed`.
 */
export function orbitOf(words: string | null, framed: CameraOrbit, unit: string): CameraOrbit {
  const [theta, phi, radius] = split(words);
  return {
    theta: angle(theta) ?? framed.theta,
    phi: angle(phi) ?? framed.phi,
    radius: (radius?.endsWith("%") ? (number(radius, "%") ?? NaN) / 100 * framed.radius : length(radius, unit)) || framed.radius,
  };
}

/**
 * Parses a point such as "0.1m 0m 20mm" and returns it in model coordinates. Parts that are `auto`,
 * missing or malformed are taken from `centre`.
 */
export function targetOf(words: string | null, centre: Vec3, unit: string): Vec3 {
  const parts = split(words);
  return centre.map((middle, axis) => length(parts[axis], unit) ?? middle) as Vec3;
}

/**
 * Parses an angle such as "30deg" and returns it in degrees, clamped to 1 to 120. Returns
 * `otherwise` if the text is missing or malformed.
 */
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

/** Parses a length such as "20mm" and returns it in model units. If the model has no unit, metres are assumed. */
function length(word: string | undefined, unit: string): number | undefined {
  const [, value, given] = /^(.*?)(mm|cm|m)$/.exec(word ?? "") ?? [];
  return scaled(value, (kMetres[given ?? ""] ?? NaN) / (kMetres[unit] ?? 1));
}

function scaled(value: string | undefined, factor: number | undefined): number | undefined {
  const result = Number(value || NaN) * (factor ?? NaN);
  return Number.isFinite(result) ? result : undefined;
}
