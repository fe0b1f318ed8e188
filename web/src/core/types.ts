// SPDX-License-Identifier: Apache-2.0
// Types of the data that page, worker and decoder exchange. They depend on neither three.js nor the
// DOM.
import type { Attribute, Semantic } from "./attributes.ts";
import type { Presentation } from "./presentation.ts";

/** A view of a model by a perspective camera, with limits on the detail. */
export interface CameraView {
  /** 4x4 matrix from camera to model coordinates, 16 numbers in column-major order. The camera looks along its -z axis. */
  camera: number[];
  /** Vertical field of view, in degrees. */
  fov: number;
  /** Size of the viewport in device pixels. */
  width: number;
  height: number;
  /** Largest acceptable screen-space error, in device pixels. */
  pixels: number;
  /** Maximum size of the model in bytes and triangles, including header and base mesh. */
  bytes?: number;
  triangles?: number;
}

/** A detail request. `error` is the largest acceptable error in model units. Level 0 is the base mesh. */
export type Want = { triangles: number } | { bytes: number } | { error: number } | { level: number } | { view: CameraView };

export interface Level {
  vertices: number;
  faces: number;
  /** Errors in model units. */
  maxError: number;
  rmsError: number;
  /** Bytes from the start of the file to the end of this level. */
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

/** The content of a picture. `surface` holds occlusion (red), roughness (green) and metallic (blue). */
export type PictureRole = "colour" | "normal" | "surface" | "emission";

/** A square WebP picture of the model's surface. */
export interface Picture {
  role: PictureRole;
  /** Width and height, in pixels. */
  side: number;
  /** Position in the file, in bytes from the start. */
  offset: number;
  length: number;
  /** 64 lower-case hexadecimal digits. */
  sha256: string;
}

export interface TextureInfo {
  /** Position of the base mesh's texture coordinates in the file, in bytes. */
  atlasOffset: number;
  atlasLength: number;
  alphaMode: "opaque" | "mask" | "blend";
  /** Smallest visible opacity, if `alphaMode` is "mask". */
  alphaCutoff: number;
  isDoubleSided: boolean;
  isUnlit: boolean;
  /**
   * In ascending order of `side`. The first `inHead` pictures are in the file's head, after the
   * base mesh.
   */
  pictures: Picture[];
  inHead: number;
}

export interface ModelInfo {
  /** All levels. levels[0] is the base mesh; the last level is full resolution. */
  levels: Level[];
  chunks: Chunk[];
  baseOffset: number;
  baseLength: number;
  fileBytes: number;
  attributes: Semantic[];
  /**
   * Positions are rounded to a lattice with `bits` bits per coordinate. `step` is its step in model
   * units.
   */
  bits: number;
  step: number;
  /** The unit of the model's coordinates, or "" if unknown. */
  unit: string;
  /** The origin of surface positions, in model coordinates. */
  centre: [number, number, number];
  texture?: TextureInfo;
  /** How the daemon presents the model. Absent if the model is shown as it is in the file. */
  presentation?: Presentation;
}

/**
 * A state of the surface that is ready for display. If the model has a texture, a vertex on the border of two charts
 * occurs once for each of its texture coordinates.
 */
export interface Surface {
  triangles: number;
  vertices: number;
  /** Bytes downloaded for this state, including header and base mesh. */
  bytes: number;
  /** 3 coordinates per vertex, in model units relative to `ModelInfo.centre`. */
  positions: Float32Array;
  /** 4 numbers per vertex: the components of the unit normal, scaled by 32767, and 0 as padding. */
  normals: Int16Array;
  /** The model's attributes, each with the width given in attributes.ts. Colours are linear; 65535 means 1. */
  attributes: Attribute<Uint16Array>[];
  /** 2 texture coordinates per vertex, from (0, 0) in the upper left corner of the pictures. Absent without a texture. */
  coordinates?: Float32Array;
  /** 3 vertex indices per triangle. */
  indices: Uint32Array;
}

export type NumericArray = Float32Array | Int16Array | Uint16Array | Uint32Array;

/**
 * Names of the arrays of a surface. The `from…` arrays hold the values from which a vertex morphs.
 * `fromPositions` and `fromNormals` have 4 numbers per vertex. In `fromPositions`, the fourth number
 * states which change moves the vertex.
 */
export type SurfaceArray =
  | "positions" | "normals" | Semantic | "coordinates" | "indices" | "fromPositions" | "fromNormals" | "fromCoordinates";

/** The change to the next state of the surface. Its data follow in `blocks` blocks. */
export interface Change extends Pick<Surface, "triangles" | "vertices" | "bytes"> {
  /** Number of the change, counted from 1. */
  number: number;
  blocks: number;
}

/** A range of vertices or faces in one array of a surface. */
export interface ElementRange {
  part: SurfaceArray;
  first: number;
  count: number;
}

/** The data of a range, at the start of `buffer`. The receiver must give the buffer back. */
export interface Block extends ElementRange {
  buffer: ArrayBuffer;
}

export interface Progress {
  /** Size of the current state in bytes. `total` is the size of the requested state. */
  bytes: number;
  total: number;
}

/** An error whose message tells the user what to do. */
export class ModelError extends Error {
  override name: string = "ModelError";
}

/** The received bytes do not match their hash or length. A second attempt may succeed. */
export class DamagedError extends ModelError {
  override name = "DamagedError";
}

/** The server does not respond or is overloaded (429, 5xx). A later attempt may succeed. */
export class UnreachableError extends ModelError {
  override name = "UnreachableError";
}
