// SPDX-License-Identifier: Apache-2.0
// Tests that Blender imports the exports of a published model. node --test blender.test.mjs
import assert from "node:assert/strict";
import { fileURLToPath } from "node:url";
import { after, before, test } from "node:test";
import { needs, run } from "./installed.mjs";
import { Museum, assertSame } from "./museum.mjs";

const options = needs("blender");
let museum;
before(async () => (museum = await Museum.open()));
after(() => museum?.stop());

function read(path) {
  const text = run("blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", fileURLToPath(new URL("blender.py", import.meta.url)), "--", path);
  return JSON.parse(/^IMPORTED (.*)$/m.exec(text)[1]);
}

const kTurned = { zUp: true }; // Blender turns GLB so that z is up, and keeps metres
const kInMillimetres = { scale: 1000 }, kPrinted = { scale: 1000, zUp: true };
for (const [format, units] of [["glb", kTurned], ["obj", kInMillimetres], ["ply", kInMillimetres], ["stl", kPrinted]]) {
  test(`Blender imports ${format} with all faces, in its size`, options, async () => {
    const found = read(await museum.saved("bust", format));
    assert.equal(found.meshes, 1);
    assertSame(found, museum.models.bust, units);
    if (format === "glb") assert.ok(found.smooth);
  });
}

test("Blender imports the picture of a textured glb", options, async () => {
  const found = read(await museum.saved("ball", "glb"));
  assertSame(found, museum.models.ball, kTurned);
  assert.equal(found.pictures.length, 1);
});
