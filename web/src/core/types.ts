// SPDX-License-Identifier: Apache-2.0
// The types that the stages of the viewer exchange; they depend on neither three.js nor the DOM.
import type { Attribute, Semantic } from "./attributes.ts";

/** The view of a perspective camera on a model, with limits on the detail. */
export interface CameraView {
  /** 4x4 matrix from camera to model coordinates, 16 numbers in column-major order. The camera looks along its -z axis. */
  camera: number[];
  /** Vertical field of view, degrees. */
  fov: number;
  /** Size of the viewport in device pixels. */
  width: number;
  height: number;
  /** Largest acceptable screen-space error, device pixels. */
  pixels: number;
  /** Maximum size of the model in bytes and triangles, including header and base mesh. */
  bytes?: number;
  triangles?: number;
}

/** A detail request. `error` is in model units; level 0 is the base mesh. */
export type Want = { triangles: number } | { bytes: number } | { error: number } | { level: number } | { view: CameraView };

export interface Level {
  vertices: number;
  faces: number;
  /** Errors in model units. */
  maxError: number;
  rmsError: number;
  /** Bytes of the file up to and including this level. */
  cumulativeBytes: number;
}

export interface Chunk {
  level: number;
  region: number;
  /** Position in the file, in bytes from the start. */
  offset: number;
  length: number;
  /** 64 lower-case hexadecimal digits. */
  sha256: string;
}

export interface ModelInfo {
  /** All levels: levels[0] is the base mesh, and the last one is full resolution. */
  levels: Level[];
  chunks: Chunk[];
  baseOffset: number;
  baseLength: number;
  fileBytes: number;
  attributes: Semantic[];
  /** Lattice bits per coordinate, and the lattice step in model units. */
  bits: number;
  step: number;
  /** The unit of the model's coordinates, or "" if unknown. */
  unit: string;
  /** The surface's origin in model coordinates. */
  centre: [number, number, number];
}

/** A state of the surface, ready for display. */
export interface Surface {
  triangles: number;
  vertices: number;
  /** Bytes downloaded for this state, including header and base mesh. */
  bytes: number;
  /** 3 coordinates per vertex, in model units relative to `ModelInfo.centre`. */
  positions: Float32Array;
  /** 4 numbers per vertex: the unit normal times 32767, and 0. */
  normals: Int16Array;
  /** The model's attributes, each with the width given in attributes.ts. Colours are linear; 65535 stands for 1. */
  attributes: Attribute<Uint16Array>[];
  /** 3 vertex indices per triangle. */
  indices: Uint32Array;
}

export type NumericArray = Float32Array | Int16Array | Uint16Array | Uint32Array;

/**
 * Names of the arrays of a surface. The `from…` arrays have 4 numbers per vertex: the position or normal from which
 * the vertex morphs. In `fromPositions`, the fourth is the number of the change that moves the vertex.
 */
export type SurfaceArray = "positions" | "normals" | Semantic | "indices" | "fromPositions" | "fromNormals";

/** The next state of the surface. Its new data follow in `blocks` blocks. */
export interface Change extends Pick<Surface, "triangles" | "vertices" | "bytes"> {
  /** Number of the change, counted from 1. */
  number: number;
  blocks: number;
}

/** A range of vertices or faces in one array of a surface. */
export interface Place {
  part: SurfaceArray;
  first: number;
  count: number;
}

/** The data of a range, at the start of `buffer`. The buffer is borrowed and must be given back. */
export interface Block extends Place {
  buffer: ArrayBuffer;
}

export interface Progress {
  /** Bytes of the current state; `total` is the number of bytes of the requested state. */
  bytes: number;
  total: number;
}

/** An error whose message tells the user what to do. */
export class ModelError extends Error {
  override name: string = "ModelError";
}

/** The received bytes do not match their hash or length; a second attempt may succeed. */
export class DamagedError extends ModelError {
  override name = "DamagedError";
}

/** The server does not respond or is overloaded (429, 5xx); a later attempt may succeed. */
export class UnreachableError extends ModelError {
  override name = "UnreachableError";
}
