// SPDX-License-Identifier: Apache-2.0
// Tests that glTF-Transform reads, inspects and writes the GLB exports of published models. node --test gltf_transform.test.mjs
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Logger, NodeIO } from "@gltf-transform/core";
import { ALL_EXTENSIONS } from "@gltf-transform/extensions";
import { dedup, dequantize, getBounds, inspect, weld } from "@gltf-transform/functions";
import draco3d from "draco3dgltf";
import { MeshoptDecoder, MeshoptEncoder } from "meshoptimizer";
import { Museum, assertSame } from "./museum.mjs";

let museum, io;
before(async () => {
  museum = await Museum.open();
  await Promise.all([MeshoptDecoder.ready, MeshoptEncoder.ready]);
  io = new NodeIO().setLogger(new Logger(Logger.Verbosity.SILENT)).registerExtensions(ALL_EXTENSIONS).registerDependencies({
    "draco3d.decoder": await draco3d.createDecoderModule(), "draco3d.encoder": await draco3d.createEncoderModule(),
    "meshopt.decoder": MeshoptDecoder, "meshopt.encoder": MeshoptEncoder,
  });
});
after(() => museum?.stop());

/** Returns the number of triangles and the size of a document, and the attributes of its only mesh. */
function described(document) {
  const { meshes, textures } = inspect(document), [scene] = document.getRoot().listScenes(), { min, max } = getBounds(scene);
  assert.equal(meshes.properties.length, 1);
  const [{ glPrimitives, attributes }] = meshes.properties;
  return { triangles: glPrimitives, size: max.map((high, axis) => high - min[axis]), attributes: attributes.map((text) => text.split(":")[0]), textures: textures.properties };
}

for (const compression of ["none", "meshopt", "draco"]) {
  test(`glTF-Transform reads and writes export.glb?compression=${compression}`, async () => {
    const document = await io.readBinary(new Uint8Array(await museum.exported("bust", "glb", `compression=${compression}`)));
    const found = described(document);
    assertSame(found, museum.models.bust);
    assert.deepEqual(found.attributes.sort(), ["COLOR_0", "NORMAL", "POSITION"]);
    assert.equal(document.getRoot().getAsset().copyright.includes("A. Sculptor"), true);
    await document.transform(dequantize(), dedup());
    assertSame(described(await io.readBinary(await io.writeBinary(document))), museum.models.bust);
  });
}

test("glTF-Transform finds the texture, and welding keeps its seams", async () => {
  const document = await io.readBinary(new Uint8Array(await museum.exported("ball", "glb")));
  const [{ mimeType, slots }] = described(document).textures;
  assert.deepEqual([mimeType, slots], ["image/jpeg", ["baseColorTexture"]]);
  await document.transform(weld());
  assertSame(described(document), museum.models.ball);
});
