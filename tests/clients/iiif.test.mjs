// SPDX-License-Identifier: Apache-2.0
// Tests that clients of IIIF read the daemon's manifests. @iiif/parser and manifesto.js read the manifests of Presentation 3;
// 3d-manifesto-dev reads the scene of Presentation 4. If VITRINE_IIIF_VALIDATOR is a folder with the source of IIIF's
// presentation-validator, also checks the documents with its schemas, which no registry has.
// node --test iiif.test.mjs
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import * as manifesto3d from "@iiif/3d-manifesto-dev";
import { normalize, serialize, serializeConfigPresentation3 } from "@iiif/parser";
import * as manifesto from "manifesto.js";
import { Museum } from "./museum.mjs";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const schemas = process.env.VITRINE_IIIF_VALIDATOR;

let museum, three, four, collection;
before(async () => {
  museum = await Museum.open();
  const { id } = museum.models.bust;
  [three, four, collection] = await Promise.all([`${id}/manifest.json`, `4/${id}/manifest.json`, "collection.json"].map((path) => museum.json(`/api/v1/iiif/${path}`)));
});
after(() => museum?.stop());

test("@iiif/parser takes manifest and collection apart and writes the same again", () => {
  for (const document of [three, collection]) {
    const { entities, mapping, resource } = normalize(structuredClone(document));
    assert.deepEqual(serialize({ entities, mapping, requests: {} }, resource, serializeConfigPresentation3), document);
  }
});

test("manifesto.js finds the poster on the canvas and the downloads", async () => {
  const manifest = manifesto.parseManifest(three), canvases = manifest.getSequences()[0].getCanvases();
  assert.equal(manifest.getLabel().getValue(), "bust");
  assert.equal(canvases.length, 1);
  const [{ id }] = canvases[0].getContent()[0].getBody();
  for (const url of [id, ...manifest.getRenderings().map((rendering) => rendering.id)]) assert.equal((await fetch(url)).status, 200, url);
});

test("3d-manifesto-dev finds the model in the scene", async () => {
  const [scene] = manifesto3d.parseManifest(four).getSequences()[0].getScenes(), [annotation] = scene.getContent(), [model] = annotation.getBody();
  assert.equal(annotation.getTarget().id, scene.id);
  assert.ok(model.isModel());
  assert.equal(model.getFormat(), (await fetch(model.id)).headers.get("content-type"));
});

describe("the validator of IIIF accepts", { skip: schemas ? false : "VITRINE_IIIF_VALIDATOR is not set" }, () => {
  const json = (...path) => JSON.parse(readFileSync(join(schemas, "schema", ...path), "utf8"));

  function check(Ajv, document, find) {
    const ajv = new Ajv({ strict: false, allErrors: true });
    require("ajv-formats").default(ajv);
    const valid = find(ajv);
    assert.ok(valid(document), JSON.stringify(valid.errors, null, 1));
  }

  test("manifest and collection of Presentation 3", () => {
    for (const document of [three, collection]) check(require("ajv").default, document, (ajv) => ajv.compile(json("iiif_3_0.json")));
  });

  test("the manifest of Presentation 4", () => {
    check(require("ajv/dist/2020").default, four, (ajv) => {
      for (const name of readdirSync(join(schemas, "schema/v4")).filter((file) => file.endsWith(".json"))) ajv.addSchema(json("v4", name));
      return ajv.getSchema("https://iiif.io/api/presentation/4.0/schema/Manifest.json");
    });
  });
});
