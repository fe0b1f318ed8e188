// SPDX-License-Identifier: Apache-2.0
// Camera positions as numbers for links, and as words for screen readers. Angles are in degrees.
// Azimuth 0 is the front, and azimuth 90 is the right side. Elevation 90 is above.

export interface OrbitView {
  azimuth: number;
  elevation: number;
  /** Distance from the target, in the unit of the presented model. */
  distance: number;
  /** The point that the camera looks at, in the coordinates of the presented (rotated and scaled) model. */
  target: [number, number, number];
}

type Vector = { x: number; y: number; z: number };

const kSides = ["front", "front-right", "right", "back-right", "back", "back-left", "left", "front-left"] as const;
const kDegrees = 180 / Math.PI;

export type Side = (typeof kSides)[number];
export type Height = "above" | "level" | "below";

export function anglesOf({ x, y, z }: Vector): { azimuth: number; elevation: number; distance: number } {
  const distance = Math.hypot(x, y, z);
  return { azimuth: Math.atan2(x, z) * kDegrees, elevation: Math.asin(distance > 0 ? y / distance : 0) * kDegrees, distance };
}

export function offsetOf({ azimuth, elevation, distance }: Omit<OrbitView, "target">): Vector {
  const flat = distance * Math.cos(elevation / kDegrees);
  return {
    x: flat * Math.sin(azimuth / kDegrees),
    y: distance * Math.sin(elevation / kDegrees),
    z: flat * Math.cos(azimuth / kDegrees),
  };
}

export function sideOf(azimuth: number): Side {
  return kSides[((Math.round(azimuth / 45) % 8) + 8) % 8] as Side;
}

export function heightOf(elevation: number): Height {
  return elevation > 25 ? "above" : elevation < -25 ? "below" : "level";
}

/** Formats a view for a link as six numbers. The rounding makes no visible difference. */
export function formatView({ azimuth, elevation, distance, target }: OrbitView): string {
  return [azimuth.toFixed(1), elevation.toFixed(1), ...[distance, ...target].map((value) => Number(value.toPrecision(5)))].join(",");
}

/** Parses a view from a link. Returns undefined if the text is malformed. */
export function parseView(text: string): OrbitView | undefined {
  const numbers = text.split(",").map(Number);
  const [azimuth = NaN, elevation = NaN, distance = NaN, x = NaN, y = NaN, z = NaN] = numbers;
  if (numbers.length !== 6 || !numbers.every(Number.isFinite) || distance <= 0 || Math.abs(elevation) > 90) return undefined;
  return { azimuth, elevation, distance, target: [x, y, z] };
}
