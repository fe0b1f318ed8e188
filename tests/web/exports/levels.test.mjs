// SPDX-License-Identifier: Apache-2.0
// Shows the levels of detail of a model in Chromium. 3DTilesRendererJS shows the tileset of 3D Tiles, and Babylon.js shows the GLB
// with MSFT_lod.
// node --test levels.test.mjs
import assert from "node:assert/strict";
import { mkdir, mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { build } from "esbuild";
import validator from "gltf-validator";
import { launch, newContext } from "../../e2e/browser.mjs";
import { Daemon } from "../../e2e/daemon.mjs";
import { readObj, writeColoured, writeStripedBall } from "../../e2e/models.mjs";
import { serve } from "../package/site.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: model, VITRINE_SCREENSHOTS: pictures } = process.env;

let daemon, browser, site, folder, bust, ball;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vitrine-"));
  const entryPoints = ["tiles", "babylon"].map((name) => join(import.meta.dirname, "pages", `${name}.js`));
  await build({ entryPoints, outdir: folder, bundle: true, format: "esm", logLevel: "error" });
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  site = await serve(folder);
  await writeColoured(await readObj(model), join(folder, "bust.ply"));
  await writeStripedBall(join(folder, "ball.glb"), { around: 64, up: 32 });
  [bust, ball] = await Promise.all([["bust.ply", "mm"], ["ball.glb", "m"]].map(([name, unit]) => published(name, unit)));
});
after(async () => {
  site?.close();
  await browser?.close();
  await daemon?.stop();
  await rm(folder, { recursive: true });
});

/**
 * Publishes a model. Returns the URL of the model in the API, and its numbers of triangles from the base mesh to the finest
 * level.
 */
async function published(name, unit) {
  const page = await daemon.publish(join(folder, name), name, "--unit", unit);
  const api = page.replace("/models/", "/api/v1/models/");
  const { levels } = await (await fetch(`${api}/manifest`)).json();
  return { api, faces: levels.map((level) => level.faces) };
}

/** Opens a page of another origin than the daemon's. Returns the page, and a list of the requests to the daemon. */
async function open(name, source) {
  const context = await newContext(browser, { viewport: { width: 900, height: 700 } });
  const page = await context.newPage(), asked = [], errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("request", (request) => request.url().startsWith(daemon.url) && asked.push(request));
  await page.addInitScript((address) => (window.source = address), source);
  await page.goto(`${site.url}${name}.html`);
  await page.waitForFunction(() => window.isReady || window.result, null, { timeout: 60_000 });
  assert.deepEqual(errors, []);
  return { page, asked };
}

/** Returns the tiles of a tileset, from the base mesh to the finest level. */
async function chainOf(api) {
  const tiles = [];
  for (let tile = (await (await fetch(`${api}/tileset.json`)).json()).root; tile; tile = tile.children?.[0]) tiles.push(tile);
  return tiles;
}

const levelOf = (address) => Number(/level=(\d+)$/.exec(address)[1]);

test("3DTilesRendererJS shows the base mesh from afar and the finest level from near, upright", async () => {
  const levels = (await chainOf(bust.api)).map(({ content }) => levelOf(content.uri));
  assert.ok(levels.length >= 3 && levels[0] === 0 && levels.at(-1) === bust.faces.length - 1, `${levels}`);
  const { page, asked } = await open("tiles", `${bust.api}/tileset.json`);
  const asks = () => asked.map((request) => request.url()).filter((url) => url.includes("/export.glb")).map(levelOf);

  const far = await page.evaluate(() => window.look(100));
  assert.deepEqual([far.failures, far.meshes, far.triangles], [[], 1, bust.faces[0]]);
  assert.deepEqual(asks(), [0]);

  const near = await page.evaluate(() => window.look(3));
  assert.deepEqual([near.failures, near.meshes, near.triangles], [[], 1, bust.faces.at(-1)]);
  assert.deepEqual(asks(), levels);
  await page.screenshot({ path: join(pictures, "tileset.png") });

  const { bounding_box: { min, max } } = await (await fetch(`${bust.api}/manifest`)).json();
  const wanted = { low: [min[0], -max[2], min[1]], high: [max[0], -min[2], max[1]] };
  for (const corner of ["low", "high"])
    near[corner].forEach((part, k) => assert.ok(Math.abs(part - wanted[corner][k] / 1000) < 1e-5 * (max[1] - min[1]), `${near[corner]}`));
  assert.ok(far.isInVolume && near.isInVolume);
  await page.context().close();
});

test("3DTilesRendererJS shows the texture of each tile", async () => {
  const { page } = await open("tiles", `${ball.api}/tileset.json`);
  const { failures, triangles } = await page.evaluate(() => window.look(3));
  assert.deepEqual([failures, triangles], [[], ball.faces.at(-1)]);
  await page.screenshot({ path: join(pictures, "tileset_textured.png") });
  await page.context().close();
});

for (const [name, of] of [["coloured", () => bust], ["textured", () => ball]]) {
  test(`Babylon.js shows one ${name} level after the other, and ends at the finest`, async () => {
    const { api, faces } = of();
    const wanted = (await chainOf(api)).map(({ content }) => faces[levelOf(content.uri)]);
    const { page, asked } = await open("babylon", `${api}/export.glb?lod=msft`);
    const result = await page.evaluate(() => window.result);
    assert.deepEqual(result.steps, wanted);
    assert.equal(result.triangles, faces.at(-1));
    assert.deepEqual([result.meshes, result.allMeshes], [1, 1], "the coarser levels are gone");
    assert.deepEqual(result.hasTexture, [name === "textured"], "the levels share one material");
    const { issues } = await validator.validateBytes(new Uint8Array(await (await fetch(`${api}/export.glb?lod=msft`)).arrayBuffer()));
    assert.deepEqual(issues.messages.filter(({ severity }) => severity < 2), []);
    assert.ok(asked.length > wanted.length && asked.every((request) => request.headers().range), "each level is requested by itself");
    await page.screenshot({ path: join(pictures, `msft_lod_${name}.png`) });
    await page.context().close();
  });
}
