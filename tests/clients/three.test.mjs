// SPDX-License-Identifier: Apache-2.0
// Tests the npm package's loader and element, and the GLB exports, in Chromium. Uses the oldest and the newest three.js that the
// package supports.
// node --test three.test.mjs
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { Museum, assertSame } from "./museum.mjs";
import { ClientPage, packageFolder } from "./page.mjs";

let museum;
before(async () => (museum = await Museum.open()));
after(() => museum?.stop());

const version = (name) => JSON.parse(readFileSync(join(packageFolder(name), "package.json"), "utf8")).version;

test("the oldest three.js is that of the peer range", () => {
  const { peerDependencies } = JSON.parse(readFileSync(new URL("../../web/package.json", import.meta.url), "utf8"));
  assert.equal(`${peerDependencies.three}.0`, `>=${version("three-oldest")}`);
});

for (const name of ["three-oldest", "three-newest"]) {
  describe(`three.js ${version(name)}`, () => {
    let client;
    before(async () => {
      const folders = { draco: join(packageFolder(name), "examples/jsm/libs/draco/gltf") };
      client = await ClientPage.open("three", { alias: { three: name }, folders });
    });
    after(() => client?.close());

    for (const compression of ["none", "meshopt", "draco"]) {
      test(`shows the whole model from export.glb?compression=${compression}`, async () => {
        const found = await client.call("glb", `${museum.api("bust")}/export.glb?compression=${compression}`);
        assertSame(found, museum.models.bust);
        assert.ok(found.covered > 10_000, `${found.covered} pixels`);
      });
    }

    test("shows the texture of export.glb", async () => {
      const found = await client.call("glb", `${museum.api("ball")}/export.glb`);
      assertSame(found, museum.models.ball);
      assert.ok(found.red > 0.3 * found.covered && found.blue > 0.3 * found.covered, JSON.stringify(found));
    });

    test("shows the base mesh with the package's loader, and refines it to the last triangle", async () => {
      const found = await client.call("progressive", museum.api("bust"));
      assert.ok(found.base < found.triangles / 10, `${found.base} triangles at first`);
      assertSame(found, museum.models.bust, { scale: 1000 });
      assert.ok(found.covered > 10_000, `${found.covered} pixels`);
      await client.screenshot(name);
      assert.deepEqual(client.errors, []);
    });

    test("shows a textured model in the package's element, lit by the room", async () => {
      const page = await ClientPage.open("element", { alias: { three: name } });
      const found = await page.call("show", museum.api("ball"));
      await page.screenshot(`element-${name}`);
      assert.ok(found.red > 0.2 * found.covered && found.blue > 0.2 * found.covered, JSON.stringify(found));
      assert.ok(found.lit > 1.3 * found.unlit, `the room's light: ${JSON.stringify(found)}`);
      assert.deepEqual(page.errors, []);
      await page.close();
    });
  });
}
