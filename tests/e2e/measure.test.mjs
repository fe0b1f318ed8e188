// SPDX-License-Identifier: Apache-2.0
// Measures angles, areas and profiles on a ball of radius 1, whose measures are known.
// Environment: VITRINE_BIN, VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm } from "node:fs/promises";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { ViewerPage, launch } from "./browser.mjs";
import { writeStripedBall } from "./models.mjs";
import { StaticHost } from "./static_host.mjs";

const { VITRINE_BIN: bin, VITRINE_SCREENSHOTS: pictures } = process.env;
const axe = await readFile(createRequire(new URL("../../web/package.json", import.meta.url)).resolve("axe-core/axe.min.js"), "utf8");

let browser, host, folder, viewer, page;

before(async () => {
  await mkdir(pictures, { recursive: true });
  browser = await launch();
  host = await StaticHost.start();
  folder = await mkdtemp(join(tmpdir(), "vitrine-measure-"));
  const ball = join(folder, "ball.glb"), pmesh = join(folder, "ball.pmesh");
  await writeStripedBall(ball, { around: 128, up: 64 });
  await promisify(execFile)(join(bin, "vitrine"), ["build", ball, "-o", pmesh]);
  host.add("ball.pmesh", await readFile(pmesh));
  // The field of view is small and the camera far away, so the projection is nearly parallel.
  viewer = await ViewerPage.open(browser, host.page({
    src: `${host.url}/ball.pmesh`, alt: "Ball", lang: "en", "camera-controls": "", "camera-orbit": "0deg 90deg auto", "field-of-view": "5deg",
  }));
  ({ page } = viewer);
  await viewer.events("load");
  await viewer.sheet("measure");
});

after(async () => {
  await browser?.close();
  host?.stop();
  await rm(folder, { recursive: true, force: true });
});

/**
 * Clicks points. Each point is [x, y]: its offsets from the ball's centre on the screen, to the
 * right and upwards, in radii of the ball.
 */
async function click(...points) {
  const box = await page.locator("canvas").boundingBox();
  // The ball fills 85 % of the height.
  const radius = (0.85 * box.height) / 2;
  for (const [x, y] of points) await page.mouse.click(box.x + box.width / 2 + x * radius, box.y + box.height / 2 - y * radius);
}

const choose = (kind) => page.locator(`label:has([value=${kind}])`).click();
const result = async () => Number.parseFloat(await page.locator(".sheet .result:not(.size)").textContent());
const near = (value, expected, part = 0.03) => assert.ok(Math.abs(value - expected) < part * expected, `${value} instead of ${expected}`);

test("three points make an angle, at the second of them", async () => {
  await choose("angle");
  await click([-0.6, 0], [0, 0.6], [0.6, 0]);
  // On the unit ball, these are the points (-0.6, 0, 0.8), (0, 0.6, 0.8) and (0.6, 0, 0.8).
  near(await result(), 90);
  assert.match(await page.locator(".sheet .result:not(.size)").textContent(), /°$/);
  assert.equal(await page.locator(".ruler").count(), 2);
  await viewer.picture(join(pictures, "measure-angle.png"));
});

test("three and more points enclose an area", async () => {
  await choose("area");
  assert.equal(await page.locator(".ruler").count(), 0);
  await click([-0.5, -0.5], [-0.5, 0.5]);
  assert.ok(await page.locator(".sheet .result:not(.size)").isHidden());
  await click([0.5, 0.5]);
  near(await result(), 0.5);
  await click([0.5, -0.5]);
  near(await result(), 1);
  assert.match(await page.locator(".sheet .result:not(.size)").textContent(), / m²$/);
  assert.equal(await page.locator(".ruler").count(), 4);
  await viewer.picture(join(pictures, "measure-area.png"));
});

test("a profile along a cut is drawn and saved as CSV and SVG", async () => {
  await choose("profile");
  assert.ok(!host.asked.includes("GET /progressive-mesh-profile.js"), "its code is loaded on its first use");
  await click([-0.6, 0], [0.6, 0]);
  await page.locator(".profile svg").waitFor();
  assert.ok(host.asked.includes("GET /progressive-mesh-profile.js"));
  const chord = await result();
  near(chord, 1.2);
  const saved = async (name) => {
    const [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name }).click()]);
    assert.equal(file.suggestedFilename(), `profile.${name.toLowerCase()}`);
    return (await readFile(await file.path())).toString();
  };
  const [head, ...rows] = (await saved("CSV")).trim().split("\r\n");
  assert.match(head, /^distance.*,height/);
  assert.equal(rows.length, 512);
  // The profile is an arc of a circle of radius 1. In its middle, it is about 0.2 above the chord.
  for (const row of rows) {
    const [distance, height] = row.split(",").map(Number), x = distance - chord / 2;
    assert.ok(Math.abs(height - (Math.sqrt(1 - x * x) - Math.sqrt(1 - (chord / 2) ** 2))) < 0.005, row);
  }
  assert.match(await saved("SVG"), /^<svg xmlns="http:\/\/www\.w3\.org\/2000\/svg"/);
  await viewer.picture(join(pictures, "measure-profile.png"));
});

test("axe finds no fault, and nothing is left when the measure is cleared", async () => {
  await page.evaluate(axe);
  assert.deepEqual(await page.evaluate(async () => (await window.axe.run("progressive-mesh")).violations.map(({ id }) => id)), []);
  await page.getByRole("button", { name: "Clear" }).click();
  assert.equal(await page.locator(".ruler, .point").count(), 0);
  assert.ok(await page.locator(".profile").isHidden());
  assert.deepEqual(await viewer.complaints(), []);
});
