// SPDX-License-Identifier: Apache-2.0
// How the daemon presents a model (server/metadata/presentation.h): upright, in its unit, in a chosen view and light. A .pmesh file on
// a static host has no presentation.

/** A view of a presented model. Angles are in degrees; azimuth 0 is the front, and elevation 90 is above. */
export interface PresentedView {
  azimuth: number;
  elevation: number;
  /** 1 shows the whole model. */
  zoom: number;
  /** The point in the middle of the view, after the model's rotation and scaling. Null stands for the centre of the model. */
  target: [number, number, number] | null;
}

export interface PresentedLight {
  preset: "studio" | "raking" | "relief";
  /** Direction of raking light in degrees, clockwise from the top. */
  angle: number;
}

export interface Presentation {
  /** Unit quaternion x, y, z, w. Turns model coordinates so that y points up. */
  rotation: [number, number, number, number];
  /** Factor that converts model coordinates to the model's unit. */
  scale: number;
  view: PresentedView | null;
  poster: PresentedView | null;
  light: PresentedLight | null;
  /** Number of notes that the daemon has for the model. Missing if there are none. */
  notes?: number;
}

/** Reads the text that comes with a model's head. Returns undefined if there is none or if it is malformed. */
export function presentationOf(text: string | undefined): Presentation | undefined {
  try {
    const json = JSON.parse(text || "null") as Presentation | null;
    return json && json.rotation.every(Number.isFinite) && json.scale > 0 ? json : undefined;
  } catch {
    return undefined;
  }
}
