// SPDX-License-Identifier: Apache-2.0
// Checks that the native decoder and WebAssembly produce identical bytes. Builds every model with
// `--placement midpoint` and with `--placement pyramid`, and compares all states from the base mesh to
// full resolution.
// node native_equal.mjs VITRINE STATE_HASH DECODER.wasm MODELS GOLDEN
import { execFile } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtemp, readdir, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { promisify } from "node:util";
import { writeStripedBall } from "../e2e/models.mjs";
import { loadCore, openFile } from "./support/core.mjs";

const run = promisify(execFile);
const [vitrine, stateHash, wasm, models, golden] = process.argv.slice(2);
const core = await loadCore(wasm);

/**
 * A decoder that also returns lattice coordinates and colours as stored in the file. Pages do not need these
 * values.
 */
class Exact extends core.Decoder {
  get lattice() {
    return this.#ofVertices("lattice_positions", 12);
  }
  get colours() {
    return this.#ofVertices("attribute_values", 3);
  }

  /**
   * Returns the module's array named `array`, with `size` bytes per vertex. The module returns the
   * array in pieces, which are joined here.
   */
  #ofVertices(array, size) {
    const { wasm, model } = this, pieces = [];
    wasm.display(model);
    for (let count; (count = wasm.next_vertices(model)) > 0;) {
      pieces.push(new Uint8Array(wasm.memory.buffer, wasm[array](model, 0), size * count).slice());
    }
    return Buffer.concat(pieces);
  }
}

function state(decoder, { attributes }) {
  const shown = decoder.surface();
  const hash = createHash("sha256");
  const colours = attributes.length > 0 && decoder.colours;
  for (const array of [decoder.lattice, shown.indices, colours, shown.positions, shown.normals, shown.coordinates]) {
    if (array) hash.update(new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
  }
  return `${shown.triangles} ${hash.digest("hex")}`;
}

// Throws unless the bounding box of the base mesh is centred at the surface's origin. A page relies
// on this to show the model in the middle.
function checkCentred({ positions }) {
  for (const axis of [0, 1, 2]) {
    const along = positions.filter((_, i) => i % 3 === axis);
    const low = along.reduce((a, b) => Math.min(a, b)), high = along.reduce((a, b) => Math.max(a, b));
    if (Math.abs(low + high) > 0.1 * (high - low) + 1e-6) throw new Error(`the base mesh is off its centre along axis ${axis}`);
  }
}

async function inWasm(path) {
  const file = await readFile(path);
  const { decoder, info } = await openFile({ ...core, Decoder: Exact }, file);
  checkCentred(decoder.surface());
  const states = [state(decoder, info)];
  decoder.want({ level: info.levels.length });
  for (let chunk = decoder.nextChunk(); chunk !== undefined; chunk = decoder.nextChunk()) {
    const { offset, length } = info.chunks[chunk];
    const bytes = file.subarray(offset, offset + length);
    decoder.checkChunk(chunk, bytes);
    decoder.apply(chunk, bytes);
    states.push(state(decoder, info));
  }
  return states;
}

async function buildAndCompare(model, placement, folder) {
  const pmesh = join(folder, "model.pmesh");
  await run(vitrine, ["build", model, "--force", "-o", pmesh, "--bits", "12", "--placement", placement]);
  return compare(pmesh, `${model}, ${placement}`);
}

async function compare(pmesh, name) {
  const native = (await run(stateHash, [pmesh])).stdout.trim().split("\n");
  const browser = await inWasm(pmesh);
  const first = native.findIndex((line, i) => line !== browser[i]);
  const equal = first < 0 && native.length === browser.length;
  console.log(`${equal ? "equal" : "DIFFERENT"}: ${name}, ${native.length} states`);
  if (!equal) console.log(`  state ${first}: native ${native[first]}, WebAssembly ${browser[first]}`);
  return equal;
}

const folder = await mkdtemp(join(tmpdir(), "vitrine-"));
try {
  const files = (await readdir(models)).filter((name) => /\.(ply|obj|stl|off|glb)$/.test(name)).sort();
  if (files.length === 0) throw new Error(`there is no model in ${models}`);
  const ball = join(folder, "textured.glb");
  await writeStripedBall(ball, { around: 64, up: 48 });
  let equal = true;
  for (const file of [...files.map((name) => join(models, name)), ball]) {
    for (const placement of ["midpoint", "pyramid"]) {
      equal = (await buildAndCompare(file, placement, folder)) && equal;
    }
  }
  // Also compares the golden files, because they have several regions. Small sample scans have only
  // one.
  for (const file of (await readdir(golden)).filter((name) => name.endsWith(".pmesh")).sort()) {
    equal = (await compare(join(golden, file), file)) && equal;
  }
  process.exitCode = equal ? 0 : 1;
} finally {
  await rm(folder, { recursive: true, force: true });
}
