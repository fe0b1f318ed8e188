// SPDX-License-Identifier: Apache-2.0
// Tests that Babylon.js shows the GLB exports of published models in Chromium. node --test babylon.test.mjs
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { Museum, assertSame } from "./museum.mjs";
import { ClientPage, packageFolder } from "./page.mjs";

let museum, client;
before(async () => {
  museum = await Museum.open();
  const folders = { draco: join(packageFolder("three-newest"), "examples/jsm/libs/draco/gltf"), meshopt: packageFolder("meshoptimizer") };
  client = await ClientPage.open("babylon", { folders });
});
after(async () => {
  await client?.close();
  await museum?.stop();
});

for (const compression of ["none", "meshopt", "draco"]) {
  test(`Babylon.js shows the whole model from export.glb?compression=${compression}`, async () => {
    const found = await client.call("glb", `${museum.api("bust")}/export.glb?compression=${compression}`);
    assert.equal(found.meshes, 1);
    assertSame(found, museum.models.bust);
    assert.ok(found.normals);
    assert.ok(found.covered > 10_000, `${found.covered} pixels`);
    await client.screenshot(`babylon-${compression}`);
  });
}

test("Babylon.js shows the texture of export.glb", async () => {
  const found = await client.call("glb", `${museum.api("ball")}/export.glb`);
  assertSame(found, museum.models.ball);
  assert.ok(found.red > 0.3 * found.covered && found.blue > 0.3 * found.covered, JSON.stringify(found));
  await client.screenshot("babylon-texture");
  assert.deepEqual(client.errors, []);
});
