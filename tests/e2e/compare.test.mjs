// SPDX-License-Identifier: Apache-2.0
// Compares two objects with coupled cameras, side by side and one over the other.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { mkdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, newContext } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { readObj, writeColoured } from "./models.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const axe = await readFile(createRequire(new URL("../../web/package.json", import.meta.url)).resolve("axe-core/axe.min.js"), "utf8");

let daemon, browser, context, page, ids;
const errors = [];

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  const { vertices, faces } = await readObj(scan), larger = join(daemon.folder, "larger.ply");
  // The same bust in another unit and colour, ten times as large.
  await writeColoured({ vertices: vertices.map((vertex) => vertex.map((value) => 10 * value)), faces }, larger);
  ids = [await daemon.publish(scan, "Before", "--unit", "mm"), await daemon.publish(larger, "After", "--unit", "cm")].map((url) => url.split("/").pop());
  context = await newContext(browser, { viewport: { width: 1280, height: 720 }, reducedMotion: "reduce" });
  page = await context.newPage();
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
});

/** Waits until both viewers show their models. */
const shown = () => page.waitForFunction(() => [...document.querySelectorAll("progressive-mesh")].filter((viewer) => viewer.getCameraOrbit()).length === 2);

/** Returns angles, distance and target of both cameras. */
const cameras = () => page.evaluate(() => [...document.querySelectorAll("progressive-mesh")].map((viewer) => ({ ...viewer.getCameraOrbit(), target: viewer.getCameraTarget() })));

const near = (value, expected, part = 1e-3) => assert.ok(Math.abs(value - expected) <= part * Math.max(1e-3, Math.abs(expected)), `${value} instead of ${expected}`);

test("the page of an object leads to its comparison", async () => {
  await page.goto(`${daemon.url}/models/${ids[0]}`);
  await page.getByRole("link", { name: "Compare with another object" }).click();
  await page.waitForURL(/compare\.html\?left=/);
  await page.getByRole("combobox", { name: "Right object" }).selectOption({ label: "After" });
  await shown();
  assert.equal(new URL(page.url()).search, `?left=${ids[0]}&right=${ids[1]}`);
});

test("if the visitor moves one camera, the other follows, at the same size on the screen", async () => {
  const [left, right] = await cameras();
  near(right.radius / left.radius, 10, 0.02);
  const [canvas, other] = [page.locator(".left canvas"), page.locator(".right canvas")];
  for (const key of ["ArrowRight", "ArrowRight", "ArrowUp", "+"]) await canvas.press(key);
  const moved = await cameras();
  assert.ok(moved[0].theta !== left.theta && moved[0].phi !== left.phi && moved[0].radius < left.radius);
  for (const angle of ["theta", "phi"]) near(moved[1][angle], moved[0][angle]);
  near(moved[1].radius / right.radius, moved[0].radius / left.radius);
  const { x, y, width, height } = await other.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 3);
  await page.mouse.down({ button: "right" });
  await page.mouse.move(x + width / 2 + 60, y + height / 3, { steps: 3 });
  await page.mouse.up({ button: "right" });
  const panned = await cameras(), way = (index) => Math.hypot(...panned[index].target.map((value, axis) => value - moved[index].target[axis]));
  assert.ok(way(1) > 0, "the right mouse button pans");
  near(way(1) / way(0), right.radius / left.radius, 0.01);
  await page.screenshot({ path: join(pictures, "compare.png"), animations: "disabled" });
});

test("one lies over the other, up to a line that can be moved", async () => {
  await page.getByRole("button", { name: "One over the other" }).click();
  const [left, right] = [await page.locator(".left canvas").boundingBox(), await page.locator(".right canvas").boundingBox()];
  assert.deepEqual(left, right);
  const chooser = await page.getByRole("combobox", { name: "Right object" }).boundingBox();
  assert.ok(chooser.x > 640, "the choice of the right object is right of the line");
  const clip = () => page.locator(".right").evaluate((section) => getComputedStyle(section).clipPath);
  assert.match(await clip(), /50%/);
  await page.getByRole("slider", { name: "Position of the wipe" }).press("ArrowRight");
  assert.match(await clip(), /51%/);
  await page.locator(".right canvas").press("ArrowLeft");
  const [a, b] = await cameras();
  near(a.theta, b.theta);
  await page.screenshot({ path: join(pictures, "compare-wipe.png"), animations: "disabled" });
});

test("it fits on a phone, and axe finds no fault", async () => {
  const faults = async () => (await page.evaluate(() => window.axe.run(document))).violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target)}`);
  await page.evaluate(axe);
  assert.deepEqual(await faults(), []);
  await page.setViewportSize({ width: 390, height: 844 });
  await page.getByRole("button", { name: "One over the other" }).click();
  await page.screenshot({ path: join(pictures, "compare-390.png"), animations: "disabled" });
  assert.deepEqual(await faults(), []);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0);
  assert.deepEqual(errors, []);
});
