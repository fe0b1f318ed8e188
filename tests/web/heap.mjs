// SPDX-License-Identifier: Apache-2.0
// Tests the heap of the WebAssembly module. Blocks must be aligned, must not overlap and must keep
// their bytes. Requests that are too large must fail. Repeating the same requests must not grow the
// memory.
// node heap.mjs DECODER.wasm
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";

const { instance } = await WebAssembly.instantiate(await readFile(process.argv[2]), {});
const { memory, _initialize, allocate, release } = instance.exports;
_initialize();

let state = 1;
const random = (below) => (state = (state * 48271) % 2147483647) % below;
const bytesOf = ({ at, size }) => new Uint8Array(memory.buffer, at, size);

function take(size, mark) {
  const at = allocate(size) >>> 0;
  assert.notEqual(at, 0, `${size} bytes are refused`);
  assert.equal(at % 16, 0, `${size} bytes are not aligned`);
  const taken = { at, size, mark };
  bytesOf(taken).fill(mark);
  return taken;
}

function give(taken) {
  assert.ok(bytesOf(taken).every((byte) => byte === taken.mark), `${taken.size} bytes at ${taken.at} were written over`);
  release(taken.at);
}

// Allocates and releases blocks of all orders of magnitude. Most blocks are small, as in a decoder.
function churn() {
  state = 1;
  const held = [];
  for (let step = 0; step < 5_000; ++step) {
    if (held.length < 400 && random(2) === 0) held.push(take(random(1 << (1 + random(16))), step % 251));
    else if (held.length > 0) give(...held.splice(random(held.length), 1));
  }
  held.forEach(give);
}

churn();
const grown = memory.buffer.byteLength;
for (let round = 0; round < 5; ++round) churn();
assert.equal(memory.buffer.byteLength, grown, "the same again takes more memory");

// Allocates one large block, which fits without new memory only if all released blocks have been
// joined.
give(take(Math.floor(0.75 * grown), 7));
assert.equal(memory.buffer.byteLength, grown, "what lies side by side was not joined");

assert.equal(allocate(0xffff_ffff), 0, "4 GiB were granted");
assert.equal(allocate(0x7fff_fff0) * allocate(0x7fff_fff0), 0, "twice 2 GiB were granted");
release(0);
console.log(`${grown >> 16} pages, and no more`);
