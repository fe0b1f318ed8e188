// SPDX-License-Identifier: Apache-2.0
// Simplifies a mesh with meshoptimizer and moves vertices to better positions, which Debian's
// version of the library does not support:
// node simplify.mjs MESH FACES...
// MESH holds the numbers of vertices, indices and attributes per vertex (u32 each), positions (f32),
// attributes (f32) and indices (u32). For each number of faces, writes to the standard output the
// processor time in seconds (f32) and a mesh in the format of MESH. Keeps the seams of attributes,
// unless they prevent the requested number of faces.
import { readFileSync, writeSync } from "node:fs";
import { MeshoptSimplifier } from "meshoptimizer";

await MeshoptSimplifier.ready;
const [path, ...targets] = process.argv.slice(2);
const { buffer } = new Uint8Array(readFileSync(path));
const [vertices, count, width] = new Uint32Array(buffer, 0, 3);
const fine = new Float32Array(buffer, 12, 3 * vertices);
const values = new Float32Array(buffer, 12 + 12 * vertices, width * vertices);
const faces = new Uint32Array(buffer, 12 + 4 * (3 + width) * vertices, count);

const kAttributeWeight = 0.5; // as in codec/simplify/TEXTURES.md, section 1
// If a result has more than this multiple of the requested number of faces, seams have prevented
// collapses.
const kStuck = 1.2;

function reduce(target, flags) {
  const positions = fine.slice();
  const attributes = values.slice();
  const indices = faces.slice();
  const [kept] = MeshoptSimplifier.simplifyWithUpdate(
    indices, positions, 3, attributes, width, Array(width).fill(kAttributeWeight), null, 3 * target, 1, flags);
  return { positions, attributes, left: indices.slice(0, kept) };
}

function simplify(target) {
  const start = process.cpuUsage();
  let result = reduce(target, []);
  if (width > 0 && result.left.length > 3 * target * kStuck) result = reduce(target, ["Permissive"]);
  const { positions, attributes, left } = result;
  const seconds = process.cpuUsage(start).user / 1e6;
  const [remap, unique] = MeshoptSimplifier.compactMesh(left);
  const compact = (from, size) => {
    const to = new Float32Array(size * unique);
    remap.forEach((at, i) => {
      if (at < unique) to.set(from.subarray(size * i, size * i + size), size * at);
    });
    return to;
  };
  return [new Float32Array([seconds]), new Uint32Array([unique, left.length, width]), compact(positions, 3),
    compact(attributes, width), left];
}

function write(array) {
  let bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
  while (bytes.length > 0) bytes = bytes.subarray(writeSync(1, bytes));
}

for (const target of targets) simplify(Number(target)).forEach(write);
