// SPDX-License-Identifier: Apache-2.0
// What the stages of the viewer hand to each other. Nothing here knows of three.js or the DOM.

/** What a perspective camera sees of a model. */
export interface View {
  /** From the camera's coordinates to the model's, 16 numbers column by column; the camera looks along its -z. */
  camera: number[];
  /** From bottom to top, degrees. */
  fov: number;
  /** Of the viewport, device pixels. */
  width: number;
  height: number;
  /** The error that may be seen, device pixels. */
  pixels: number;
  /** The most to hold, header and base mesh included. */
  bytes?: number;
  triangles?: number;
}

/** How much of a model is asked for. `error` is in model units; level 0 is the base mesh. */
export type Want = { triangles: number } | { bytes: number } | { error: number } | { level: number } | { view: View };

export interface Level {
  vertices: number;
  faces: number;
  /** Model units. */
  maxError: number;
  rmsError: number;
  /** Bytes of the file up to and including this level. */
  cumulativeBytes: number;
}

export interface Chunk {
  level: number;
  region: number;
  /** From the start of the file, bytes. */
  offset: number;
  length: number;
  /** 64 lower-case hexadecimal digits. */
  sha256: string;
}

export interface ModelInfo {
  /** From the base mesh (levels[0]) to full resolution. */
  levels: Level[];
  chunks: Chunk[];
  baseOffset: number;
  baseLength: number;
  fileBytes: number;
  coloured: boolean;
  /** Lattice bits per coordinate, and one lattice unit in model units. */
  bits: number;
  step: number;
  /** The unit of the model's coordinates, or "" where unknown. */
  unit: string;
  /** Where the surface's origin lies in model coordinates. */
  centre: [number, number, number];
}

/** A state of the surface, ready for display. */
export interface Surface {
  triangles: number;
  vertices: number;
  /** Bytes that this state took, header and base mesh included. */
  bytes: number;
  /** 3 a vertex, model units from `ModelInfo.centre`. */
  positions: Float32Array;
  /** 4 a vertex: the unit normal times 32767, and 0. */
  normals: Int16Array;
  /** 4 a vertex, linear light, 65535 is 1; absent where the model has no colours. */
  colours: Uint16Array | undefined;
  /** 3 a triangle. */
  indices: Uint32Array;
}

/** The arrays of a surface; `from…` say where a vertex moves from: 4 numbers each, the change's number behind the place. */
export type Part = "positions" | "normals" | "colours" | "indices" | "fromPositions" | "fromNormals";

/** The next state of the surface: what is new in it comes in `blocks`. */
export interface Change extends Pick<Surface, "triangles" | "vertices" | "bytes"> {
  /** Counts the changes from 1 on. */
  number: number;
  blocks: number;
}

/** Vertices or faces of one array, from the `first` on, in the layout of Surface. */
export interface Place {
  part: Part;
  first: number;
  count: number;
}

/** `buffer` begins with the numbers of that place and is lent: give it back. */
export interface Block extends Place {
  buffer: ArrayBuffer;
}

export interface Progress {
  /** Bytes of the state on the way, and of the state asked for. */
  bytes: number;
  total: number;
}

/** A failure that a person can act on. */
export class ModelError extends Error {
  override name: string = "ModelError";
}

/** Bytes that differ from what their name says: worth a second try. */
export class DamagedError extends ModelError {
  override name = "DamagedError";
}

/** Nobody answers, or with "later": worth a try once some time has passed. */
export class UnreachableError extends ModelError {
  override name = "UnreachableError";
}
