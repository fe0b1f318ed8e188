// SPDX-License-Identifier: Apache-2.0
// Tests that our viewer and model-viewer show the same coarse model with smooth shading. model-viewer loads the model as GLB.
// node --test smooth.test.mjs
// Saves a picture as VITRINE_SCREENSHOTS/clients-smooth.png. It shows our viewer, model-viewer, and on the right model-viewer's
// faceted view of the same model without normals.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { NodeIO } from "@gltf-transform/core";
import { Museum } from "./museum.mjs";
import { ClientPage } from "./page.mjs";

const kTriangles = 2000;

let museum, folder, client;
before(async () => {
  museum = await Museum.open();
  await museum.add("plain", museum.scan, process.env.VITRINE_MODEL, "--unit", "mm");
  folder = mkdtempSync(join(tmpdir(), "vitrine-smooth-"));
  client = await ClientPage.open("smooth", { alias: { three: "three-newest" }, folders: { models: folder } });
});
after(async () => {
  await client?.close();
  await museum?.stop();
  rmSync(folder, { recursive: true, force: true });
});

/** Writes a GLB without normals. glTF requires flat shading for such a mesh. */
async function writeFlat(glb, path) {
  const io = new NodeIO(), document = await io.readBinary(new Uint8Array(glb));
  for (const mesh of document.getRoot().listMeshes()) for (const primitive of mesh.listPrimitives()) primitive.setAttribute("NORMAL", null);
  writeFileSync(path, await io.writeBinary(document));
}

test("both viewers show the same coarse model without facets", async () => {
  const query = `triangles=${kTriangles}`;
  await writeFlat(await museum.exported("plain", "glb", query), join(folder, "flat.glb"));
  const ours = await client.call("ours", museum.api("plain"), kTriangles);
  const theirs = await client.call("theirs", `${museum.api("plain")}/export.glb?${query}`);
  const flat = await client.call("theirs", "/models/flat.glb");
  await client.screenshot("smooth");
  for (const steps of [ours, theirs]) assert.ok(steps < flat / 4, `steps at ${steps} of the pixels, without normals at ${flat}`);
  assert.deepEqual(client.errors, []);
});
