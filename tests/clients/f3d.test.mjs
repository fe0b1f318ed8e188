// SPDX-License-Identifier: Apache-2.0
// Tests that F3D, a desktop viewer, draws the exports of a published model. node --test f3d.test.mjs
// Saves the pictures as VITRINE_SCREENSHOTS/clients-f3d-*.png.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { PNG } from "pngjs";
import { needs, run } from "./installed.mjs";
import { Museum } from "./museum.mjs";

const options = needs("f3d", "xvfb-run");
const pictures = process.env.VITRINE_SCREENSHOTS;
const kPixels = 400;

let museum;
before(async () => {
  mkdirSync(pictures, { recursive: true });
  museum = await Museum.open();
});
after(() => museum?.stop());

/** Draws an export on a transparent ground. Returns the red, green, blue and opacity of each pixel. */
async function drawn(name, format, ...words) {
  const picture = join(pictures, `clients-f3d-${name}-${format}.png`);
  run("xvfb-run", "--auto-servernum", "f3d", await museum.saved(name, format), `--output=${picture}`, `--resolution=${kPixels},${kPixels}`, "--no-background", ...words);
  const { data } = PNG.sync.read(readFileSync(picture));
  return Array.from({ length: data.length / 4 }, (_, i) => data.subarray(4 * i, 4 * i + 4));
}

const opaque = (pixels) => pixels.map(([, , , alpha]) => alpha > 127);

test("f3d draws the same outline from glb, obj, ply and stl", options, async () => {
  const wanted = opaque(await drawn("bust", "glb")), area = wanted.filter(Boolean).length;
  assert.ok(area > 0.1 * kPixels ** 2 && area < 0.8 * kPixels ** 2, `${area} pixels`);
  for (const [format, up] of [["obj", "+Y"], ["ply", "+Y"], ["stl", "+Z"]]) {
    const found = opaque(await drawn("bust", format, `--up=${up}`));
    const different = found.filter((inside, i) => inside !== wanted[i]).length;
    assert.ok(different < 0.03 * area, `${format}: ${different} of ${area} pixels differ`);
  }
});

test("f3d draws the texture of glb", options, async () => {
  const pixels = (await drawn("ball", "glb")).filter(([, , , alpha]) => alpha === 255);
  const red = pixels.filter(([r, , b]) => r > 2 * b).length, blue = pixels.filter(([r, , b]) => b > 2 * r).length;
  assert.ok(red > 0.3 * pixels.length && blue > 0.3 * pixels.length, `${red} red and ${blue} blue of ${pixels.length}`);
});
