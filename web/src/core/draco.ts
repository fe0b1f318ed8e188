// SPDX-License-Identifier: Apache-2.0
// Decodes the base mesh, a Draco buffer, with the npm package draco3d.
import { kAttributes, type Semantic } from "./attributes.ts";
import type { BaseMesh } from "./decoder.ts";
import { ModelError, type ModelInfo } from "./types.ts";

/** The part of the draco3d API used here. Pointers are numbers; objects have no readable members. */
export interface DracoModule {
  Decoder: new () => DracoDecoder;
  DecoderBuffer: new () => { Init(data: Int8Array, size: number): void };
  Mesh: new () => DracoMesh;
  DracoInt32Array: new () => DracoArray;
  POSITION: number;
  COLOR: number;
  HEAPF32: Float32Array;
  _malloc(size: number): number;
  _free(pointer: number): void;
  destroy(object: object): void;
}
interface DracoDecoder {
  DecodeBufferToMesh(buffer: object, mesh: DracoMesh): { ok(): boolean };
  GetAttributeId(mesh: DracoMesh, kind: number): number;
  GetAttribute(mesh: DracoMesh, id: number): { num_components(): number };
  GetAttributeInt32ForAllPoints(mesh: DracoMesh, attribute: object, out: DracoArray): boolean;
  GetTrianglesUInt32Array(mesh: DracoMesh, size: number, out: number): boolean;
}
interface DracoMesh {
  num_points(): number;
  num_faces(): number;
}
interface DracoArray {
  size(): number;
  GetValue(index: number): number;
}

/** Decodes a base mesh. Throws ModelError if its counts or attributes differ from the model's manifest. */
export function decodeBase(draco: DracoModule, bytes: Uint8Array, { levels: [level], attributes: semantics }: ModelInfo): BaseMesh {
  const decoder = new draco.Decoder();
  const buffer = new draco.DecoderBuffer();
  const mesh = new draco.Mesh();
  try {
    // Byte 7 is the geometry type (1: triangular mesh), byte 8 the encoding method (1: edgebreaker).
    if (bytes[7] !== 1 || bytes[8] !== 1) throw damaged();
    buffer.Init(new Int8Array(bytes.buffer, bytes.byteOffset, bytes.length), bytes.length);
    if (!decoder.DecodeBufferToMesh(buffer, mesh).ok()) throw damaged();
    if (mesh.num_points() !== level?.vertices || mesh.num_faces() !== level.faces) throw damaged();
    const positions = integers(draco, decoder, mesh, draco.POSITION);
    return { positions, faces: faces(draco, decoder, mesh), attributes: attributes(draco, decoder, mesh, semantics) };
  } finally {
    for (const object of [mesh, buffer, decoder]) draco.destroy(object);
  }
}

function damaged(): ModelError {
  return new ModelError("the base mesh is damaged: publish the model again");
}

/** Returns the values of all attributes of the model, one attribute after the other. */
function attributes(draco: DracoModule, decoder: DracoDecoder, mesh: DracoMesh, semantics: Semantic[]): Int32Array {
  return Int32Array.from(semantics.flatMap((semantic) => [...integers(draco, decoder, mesh, draco[kAttributes[semantic].draco])]));
}

/**
 * Returns the values of an attribute, three integers per vertex. Throws ModelError if the mesh has no such attribute.
 */
function integers(draco: DracoModule, decoder: DracoDecoder, mesh: DracoMesh, kind: number): Int32Array {
  const id = decoder.GetAttributeId(mesh, kind);
  if (id < 0) throw damaged();
  const values = new draco.DracoInt32Array();
  try {
    const attribute = decoder.GetAttribute(mesh, id);
    if (!decoder.GetAttributeInt32ForAllPoints(mesh, attribute, values)) throw damaged();
    if (values.size() !== 3 * mesh.num_points()) throw damaged();
    return Int32Array.from({ length: values.size() }, (_, i) => values.GetValue(i));
  } finally {
    draco.destroy(values);
  }
}

function faces(draco: DracoModule, decoder: DracoDecoder, mesh: DracoMesh): Uint32Array {
  const count = 3 * mesh.num_faces();
  const pointer = draco._malloc(4 * count);
  try {
    decoder.GetTrianglesUInt32Array(mesh, 4 * count, pointer);
    return new Uint32Array(draco.HEAPF32.buffer, pointer, count).slice();
  } finally {
    draco._free(pointer);
  }
}
