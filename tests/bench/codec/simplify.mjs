// SPDX-License-Identifier: Apache-2.0
// Simplifies a mesh with meshoptimizer and updated positions, which Debian's version of the library does not support:
// node simplify.mjs MESH FACES...
// MESH holds the number of vertices (u32), the number of indices (u32), positions (f32) and indices (u32). For each
// number of faces, writes the seconds of processor time (f32) and then a mesh in the form of MESH to the standard
// output.
import { readFileSync, writeSync } from "node:fs";
import { MeshoptSimplifier } from "meshoptimizer";

await MeshoptSimplifier.ready;
const [path, ...targets] = process.argv.slice(2);
const { buffer } = new Uint8Array(readFileSync(path));
const [vertices, count] = new Uint32Array(buffer, 0, 2);
const fine = new Float32Array(buffer, 8, 3 * vertices);
const faces = new Uint32Array(buffer, 8 + 12 * vertices, count);

function simplify(target) {
  const positions = fine.slice();
  const indices = faces.slice();
  const none = new Float32Array(0);
  const start = process.cpuUsage();
  const [kept] = MeshoptSimplifier.simplifyWithUpdate(
    indices, positions, 3, none, 0, [], null, 3 * target, 1);
  const seconds = process.cpuUsage(start).user / 1e6;
  const left = indices.slice(0, kept);
  const [remap, unique] = MeshoptSimplifier.compactMesh(left);
  const compact = new Float32Array(3 * unique);
  remap.forEach((to, from) => {
    if (to < unique) compact.set(positions.subarray(3 * from, 3 * from + 3), 3 * to);
  });
  return [new Float32Array([seconds]), new Uint32Array([unique, left.length]), compact, left];
}

function write(array) {
  let bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
  while (bytes.length > 0) bytes = bytes.subarray(writeSync(1, bytes));
}

for (const target of targets) simplify(Number(target)).forEach(write);
