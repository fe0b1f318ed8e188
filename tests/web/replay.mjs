// SPDX-License-Identifier: Apache-2.0
// The real WebAssembly decoder on the fuzzers' corpus and on damaged copies of it, behind the
// checksums: each must end in a surface or in a named error, never in a trap, and within a bound of
// memory: node replay.mjs DECODER.wasm CORPUS
import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import { loadCore } from "./support/core.mjs";

const kDamagedCopies = 400; // of each kind and file
const kMaxPages = 1024; // 64 MiB, for files of 20 KB

const [wasm, corpus] = process.argv.slice(2);
const { Decoder, module } = await loadCore(wasm);

/** The raw base mesh that tests/fuzz/decode/raw_base.h writes. */
function rawBase(bytes, { vertices, faces }, coloured) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = 0;
  const triples = (count, Type) => {
    const values = new Type(3 * Math.min(count, Math.floor((bytes.length - at) / 12)));
    for (let i = 0; i < values.length; ++i, at += 4) values[i] = view.getInt32(at, true);
    return values;
  };
  const [positions, corners] = [triples(vertices, Int32Array), triples(faces, Uint32Array)];
  return { positions, faces: corners, colours: coloured ? triples(vertices, Int32Array) : undefined };
}

function decode(decoder, file) {
  const info = decoder.open(file);
  const base = file.subarray(info.baseOffset, info.baseOffset + info.baseLength);
  decoder.start(rawBase(base, info.levels[0], info.coloured));
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

/** The file, cut short at many places, and with one bit of many bytes flipped. */
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
