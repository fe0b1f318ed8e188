// SPDX-License-Identifier: Apache-2.0
// Tests that TinyUSDZ, a USD library, reads the USDZ exports of published models in Chromium. Its version 0.9 ignores
// vertex colours, so the scan here has none. node --test usd.test.mjs
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Museum, assertSame } from "./museum.mjs";
import { ClientPage, packageFolder } from "./page.mjs";

let museum, client;
before(async () => {
  museum = await Museum.open();
  await museum.add("plain", museum.scan, process.env.VITRINE_MODEL, "--unit", "mm");
  client = await ClientPage.open("usd", { folders: { tinyusdz: packageFolder("tinyusdz") } });
});
after(async () => {
  await client?.close();
  await museum?.stop();
});

test("TinyUSDZ reads a scan with normals, in metres", async () => {
  const found = await client.call("read", `${museum.api("plain")}/export.usdz`);
  assert.equal(found.meshes, 1);
  assertSame(found, museum.models.plain);
  assert.equal(found.normals, 1);
});

test("TinyUSDZ reads a textured model with its JPEG", async () => {
  const found = await client.call("read", `${museum.api("ball")}/export.usdz`);
  assertSame(found, museum.models.ball);
  assert.deepEqual(found.picture, [0xff, 0xd8, 0xff]);
  assert.deepEqual(client.errors, []);
});
