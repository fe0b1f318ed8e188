// SPDX-License-Identifier: Apache-2.0
// Tests that Assimp reads the exports of a published model. node --test assimp.test.mjs
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { needs, run } from "./installed.mjs";
import { Museum, assertSame } from "./museum.mjs";

const options = needs("assimp");
let museum;
before(async () => (museum = await Museum.open()));
after(() => museum?.stop());

/** Reads a file with `assimp info`. */
function read(path) {
  const text = run("assimp", "info", path);
  const count = (name) => Number(new RegExp(`^${name}:\\s+(\\d+)`, "m").exec(text)[1]);
  const corner = (name) => new RegExp(`^${name} point\\s+\\((.+)\\)`, "m").exec(text)[1].split(" ").map(Number);
  const low = corner("Minimum"), size = corner("Maximum").map((high, axis) => high - low[axis]);
  return { triangles: count("Faces"), meshes: count("Meshes"), size, text };
}

const kMillimetres = { scale: 1000 }, kPrinted = { scale: 1000, zUp: true };
for (const [format, units] of [["glb", {}], ["obj", kMillimetres], ["ply", kMillimetres], ["stl", kPrinted], ["3mf", kPrinted]]) {
  test(`assimp counts the triangles of ${format} and finds its size`, options, async () => {
    const found = read(await museum.saved("bust", format));
    assert.equal(found.meshes, 1);
    assertSame(found, museum.models.bust, units);
  });
}

test("assimp finds the texture in glb", options, async () => {
  const found = read(await museum.saved("ball", "glb"));
  assertSame(found, museum.models.ball);
  assert.match(found.text, /\(\$tex\.file\).*BaseColor/);
});
