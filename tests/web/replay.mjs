// SPDX-License-Identifier: Apache-2.0
// Runs the real WebAssembly decoder on the files of the fuzzers' corpus and on damaged copies of
// them. Checksums are not checked. Each file must give a surface or a ModelError, never a trap, and
// memory must stay within a limit.
// node replay.mjs DECODER.wasm CORPUS
import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import { loadCore } from "./support/core.mjs";

const kDamagedCopies = 400; // approximate number of damaged copies of each file, for each kind of damage
const kMaxPages = 1024; // maximum memory, in pages of 64 KiB; the files have less than 20 KB

const [wasm, corpus] = process.argv.slice(2);
const { Decoder, module } = await loadCore(wasm);

/** Reads a raw base mesh in the layout of tests/fuzz/decode/raw_base.h. */
function rawBase(bytes, { vertices, faces }, semantics) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = 0;
  const triples = (count, Type) => {
    const values = new Type(3 * Math.min(count, Math.floor((bytes.length - at) / 12)));
    for (let i = 0; i < values.length; ++i, at += 4) values[i] = view.getInt32(at, true);
    return values;
  };
  const [positions, corners] = [triples(vertices, Int32Array), triples(faces, Uint32Array)];
  return { positions, faces: corners, attributes: Int32Array.from(semantics.flatMap(() => [...triples(vertices, Int32Array)])) };
}

function decode(decoder, file) {
  const info = decoder.open(file);
  const base = file.subarray(info.baseOffset, info.baseOffset + info.baseLength);
  decoder.start(rawBase(base, info.levels[0], info.attributes));
  decoder.surface();
  decoder.want({ triangles: info.levels.at(-1).faces / 2 });
  for (let chunk = decoder.nextChunk(); chunk !== undefined; chunk = decoder.nextChunk()) {
    const { offset, length } = info.chunks[chunk];
    decoder.apply(chunk, file.subarray(offset, offset + length));
    decoder.surface();
  }
  decoder.trim();
  return decoder.surface().triangles;
}

/** Yields the file, copies truncated at many places, and copies with one flipped bit each. */
function* copies(file) {
  yield file;
  const step = Math.max(1, Math.floor(file.length / kDamagedCopies));
  for (let at = 0; at < file.length; at += step) {
    yield file.subarray(0, at);
    const flipped = Uint8Array.from(file);
    flipped[at] ^= 1 << (at % 8);
    yield flipped;
  }
}

let surfaces = 0, errors = 0, traps = 0;
for (const name of (await readdir(corpus)).sort()) {
  for (const file of copies(await readFile(join(corpus, name)))) {
    const decoder = await Decoder.create(module);
    try {
      decode(decoder, file);
      ++surfaces;
    } catch (error) {
      if (error.name === "ModelError") ++errors;
      else console.log(`${name}: ${error.stack}`, ++traps);
    }
    if (decoder.pages > kMaxPages) throw new Error(`${name}: ${decoder.pages} pages of memory`);
  }
}
console.log(`${surfaces} surfaces, ${errors} refusals, ${traps} faults`);
process.exitCode = traps === 0 && surfaces > 0 && errors > 0 ? 0 : 1;
