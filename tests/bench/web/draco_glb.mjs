// SPDX-License-Identifier: Apache-2.0
// Makes a GLB whose only mesh is compressed by Draco (KHR_draco_mesh_compression), a format that
// other viewers load.
import { readFile } from "node:fs/promises";

const kEncoder = new URL("../../../web/node_modules/three/examples/jsm/libs/draco/draco_encoder.js", import.meta.url);

const kBits = 12;
const kIndices = { 5123: Uint16Array, 5125: Uint32Array };

/**
 * Compresses the positions and faces of a GLB with Draco's strongest compression. The GLB must have
 * one uncompressed mesh.
 */
export async function dracoGlb(glb) {
  const { json, binary } = parsed(glb);
  const { attributes, indices, material } = json.meshes[0].primitives[0];
  const values = (accessor, Kind, width) => {
    const { byteOffset = 0 } = json.bufferViews[json.accessors[accessor].bufferView];
    return new Kind(binary.slice(byteOffset, byteOffset + width * json.accessors[accessor].count * Kind.BYTES_PER_ELEMENT));
  };
  const buffer = await encoded(values(attributes.POSITION, Float32Array, 3), values(indices, kIndices[json.accessors[indices].componentType], 1));
  const compressed = { bufferView: 0, attributes: { POSITION: 0 } };
  const plain = ({ bufferView, ...rest }) => rest;
  return packed({
    ...json,
    extensionsUsed: ["KHR_draco_mesh_compression"], extensionsRequired: ["KHR_draco_mesh_compression"],
    meshes: [{ primitives: [{ attributes, indices, material, extensions: { KHR_draco_mesh_compression: compressed } }] }],
    accessors: json.accessors.map(plain),
    bufferViews: [{ buffer: 0, byteLength: buffer.length }],
    buffers: [{ byteLength: buffer.length }],
  }, buffer);
}

/** Returns the diagonal of the mesh's bounding box. */
export function diagonal(glb) {
  const { json } = parsed(glb);
  const { min, max } = json.accessors[json.meshes[0].primitives[0].attributes.POSITION];
  return Math.hypot(...max.map((value, axis) => value - min[axis]));
}

function parsed(glb) {
  const length = glb.readUInt32LE(12);
  const binary = glb.subarray(20 + length + 8);
  return { json: JSON.parse(glb.subarray(20, 20 + length)), binary: binary.buffer.slice(binary.byteOffset, binary.byteOffset + binary.length) };
}

async function encoded(positions, indices) {
  const { draco } = await encoderModule();
  const encoder = new draco.Encoder(), builder = new draco.MeshBuilder(), mesh = new draco.Mesh(), out = new draco.DracoInt8Array();
  builder.AddFacesToMesh(mesh, indices.length / 3, indices);
  builder.AddFloatAttributeToMesh(mesh, draco.POSITION, positions.length / 3, 3, positions);
  encoder.SetSpeedOptions(0, 0);
  encoder.SetAttributeQuantization(draco.POSITION, kBits);
  encoder.SetEncodingMethod(draco.MESH_EDGEBREAKER_ENCODING);
  const length = encoder.EncodeMeshToDracoBuffer(mesh, out);
  return Buffer.from(Uint8Array.from({ length }, (_, i) => out.GetValue(i)));
}

/**
 * Loads the Draco encoder that three.js contains. The encoder is a script, not a module. Returns the encoder inside an object,
 * because a promise would call the encoder's method `then`.
 */
async function encoderModule() {
  const createModule = new Function(`${await readFile(kEncoder)}; return DracoEncoderModule;`)();
  return new Promise((resolve) => createModule({ onModuleLoaded: (draco) => resolve({ draco }) }));
}

function packed(json, binary) {
  const text = Buffer.from(JSON.stringify(json));
  const chunks = [[text, 0x4e4f534a, 0x20], [binary, 0x004e4942, 0]].map(([bytes, kind, filler]) => {
    const padded = Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, filler)]), head = Buffer.alloc(8);
    head.writeUInt32LE(padded.length, 0);
    head.writeUInt32LE(kind, 4);
    return Buffer.concat([head, padded]);
  });
  const header = Buffer.alloc(12);
  [0x46546c67, 2, 12 + chunks[0].length + chunks[1].length].forEach((word, i) => header.writeUInt32LE(word, 4 * i));
  return Buffer.concat([header, ...chunks]);
}
