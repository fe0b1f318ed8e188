// SPDX-License-Identifier: Apache-2.0
// Runs the real WebAssembly decoder on the golden files and on damaged copies of them. Only the
// checksum of the header is checked. Each file must result in a surface or a ModelError, never in a
// trap, and memory must stay within a limit.
// node replay.mjs DECODER.wasm GOLDEN
import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import { loadCore } from "./support/core.mjs";

const kDamagedCopies = 400; // approximate number of copies of each file, for each kind of damage
const kMaxPages = 1024; // maximum memory in pages of 64 KiB; the files are smaller than 20 KB

const [wasm, golden] = process.argv.slice(2);
const { Decoder, module } = await loadCore(wasm);

function decode(decoder, file) {
  const info = decoder.open(file);
  const base = file.subarray(info.baseOffset, info.baseOffset + info.baseLength);
  const { atlasOffset = 0, atlasLength = 0 } = info.texture ?? {};
  decoder.start(base, file.subarray(atlasOffset, atlasOffset + atlasLength));
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

/** Yields the file, copies truncated at many places, and copies in which one bit is flipped. */
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
for (const name of (await readdir(golden)).filter((file) => file.endsWith(".pmesh")).sort()) {
  for (const file of copies(await readFile(join(golden, name)))) {
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
