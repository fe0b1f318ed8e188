// SPDX-License-Identifier: Apache-2.0
// Tests what a visitor sees of a running scan, in a real browser. The scan is simulated; the page
// and the model come from a real daemon.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, newContext } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { FakeScan, kScan, measured } from "./fake_scan.mjs";
import { readObj } from "./models.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const kPoints = 60_000;

let daemon, browser, points, model;

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  points = measured(await readObj(scan), kPoints);
  model = (await daemon.publish(scan, "Demosthenes")).split("/").pop();
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
});

/** Opens the page of the scan that `fake` simulates. */
async function watched(fake, options = {}) {
  const context = await newContext(browser, { viewport: { width: 1100, height: 760 }, ...options });
  await fake.play(context);
  const page = await context.newPage(), complaints = [];
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  await page.goto(`${daemon.url}/scans/${kScan}`, { waitUntil: "commit" });
  const says = (text) => page.locator("main").getByText(text, { exact: false }).first().waitFor({ timeout: 60_000 });
  const shoot = (name) => page.screenshot({ path: join(pictures, `scan-${name}.png`) });
  return { page, says, shoot, complaints, close: () => context.close() };
}

const part = (share) => points.subarray(0, 3 * Math.floor(share * kPoints));
const grown = (share) => `${new Intl.NumberFormat("en").format(Math.floor(share * kPoints))} points`;
const midway = (share) => ({ state: "scanning", step: Math.floor(720 * share), progress: 0.85 * share, eta: 200 * (1 - share) });

test("points grow, then the base mesh stands in their place, then the whole model", async () => {
  const fake = new FakeScan(), visitor = await watched(fake);
  await visitor.says("Waiting for the scanner");
  await visitor.shoot("waiting");
  for (const share of [0.02, 0.3, 0.7]) {
    fake.tell(midway(share), part(share));
    await visitor.says(grown(share));
    await visitor.says(`step ${Math.floor(720 * share)} of 720`);
    await frames(visitor.page);
    await visitor.shoot(`growing-${100 * share}`);
  }
  await visitor.says("about a minute left");
  fake.tell({ state: "meshing", step: 720, progress: 0.85, eta: 8 }, points);
  await visitor.says("Creating a surface from the points");
  await visitor.says("a few seconds left");
  await visitor.shoot("meshing");

  const held = [];
  await visitor.page.context().route("**/api/v1/models/*/stream", (route) => route.abort());
  await visitor.page.context().route("**/api/v1/chunks/*", (route) => void held.push(route));
  const words = wordsWhenModelled(visitor.page);
  fake.tell({ state: "done", progress: 1, eta: null, model });
  await visitor.page.locator("main.modelled").waitFor();
  assert.deepEqual(await words, ["hidden", "hidden"], "words over the viewer's own");
  await visitor.page.locator("#growth[hidden]").waitFor({ state: "hidden" });
  await visitor.shoot("base");
  await visitor.page.context().unroute("**/api/v1/chunks/*");
  await Promise.all(held.map((route) => route.continue()));
  await visitor.page.waitForFunction(() => {
    const [shown, all] = document.querySelector("progressive-mesh").shadowRoot.querySelector(".triangles").textContent.split(" of ");
    return shown !== "" && all === `${shown} triangles`;
  });
  await visitor.shoot("full");
  assert.equal(await visitor.page.title(), "Demosthenes");
  assert.deepEqual(visitor.complaints, []);
  await visitor.close();
});

for (const [name, options] of Object.entries({
  phone: { viewport: { width: 360, height: 640 } },
  kiosk: { viewport: { width: 1080, height: 1920 }, colorScheme: "dark" },
})) {
  test(`fits a ${name}`, async () => {
    const fake = new FakeScan();
    fake.tell(midway(0.5), part(0.5));
    const visitor = await watched(fake, { ...options, reducedMotion: "reduce" });
    await visitor.says(grown(0.5));
    // The document must be as large as the viewport, so that nothing can be scrolled.
    const { width, height } = options.viewport;
    assert.deepEqual(await visitor.page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]), [width, height]);
    await frames(visitor.page);
    await visitor.shoot(name);
    assert.deepEqual(visitor.complaints, []);
    await visitor.close();
  });
}

test("turns by itself, but not for who asks for less motion", async () => {
  const fake = new FakeScan();
  fake.tell(midway(1), points);
  for (const reducedMotion of ["reduce", "no-preference"]) {
    const visitor = await watched(fake, { reducedMotion, viewport: { width: 360, height: 480 } });
    await visitor.says(grown(1));
    await fake.asked(2); // after two polls, all points are shown and the camera has stopped moving
    const before = await view(visitor.page);
    const turned = () => view(visitor.page).then((after) => !after.equals(before));
    if (reducedMotion === "reduce") assert.ok(!(await turned()));
    else while (!(await turned()));
    await visitor.close();
  }
});

test("resumes where it was when the connection comes back", async () => {
  const fake = new FakeScan();
  fake.tell(midway(0.3), part(0.3));
  const visitor = await watched(fake);
  await visitor.says(grown(0.3));
  fake.fault = "network";
  await visitor.says("Connection lost");
  fake.fault = null;
  fake.tell(midway(0.6), part(0.6));
  await visitor.says(grown(0.6));
  await visitor.says("Scanning");
  await visitor.close();
});

test("shows no points of steps that are measured again", async () => {
  const fake = new FakeScan();
  fake.tell(midway(0.4), part(0.4));
  const visitor = await watched(fake);
  await visitor.says(grown(0.4));
  for (const share of [0.1, 0.6]) {
    fake.tell(midway(share), part(share));
    await visitor.says(grown(share));
    await frames(visitor.page);
    await visitor.shoot(`again-${100 * share}`);
  }
  assert.deepEqual(visitor.complaints, []);
  await visitor.close();
});

test("says what an operator should know, and resumes when the operator does", async () => {
  const fake = new FakeScan();
  fake.tell({ ...midway(0.1), state: "paused" }, part(0.1));
  const visitor = await watched(fake);
  await visitor.says("Paused");
  assert.equal(await visitor.page.locator("#left").textContent(), "");
  fake.tell({ state: "failed", error: "the board is gone; plug it in and resume the scan" });
  await visitor.says("The scan failed: the board is gone; plug it in and resume the scan");
  await visitor.shoot("failed");
  fake.tell({ state: "cancelled", error: null });
  await visitor.says("The scan was cancelled");
  assert.deepEqual(visitor.complaints, []);
  await visitor.close();
});

test("a scan that is over shows its model at once, without its points", async () => {
  const fake = new FakeScan();
  fake.tell({ state: "done", step: 720, progress: 1, model }, points);
  const visitor = await watched(fake);
  await visitor.page.locator("main.modelled").waitFor();
  assert.equal(await visitor.page.locator("#points").textContent(), "");
  assert.equal(fake.questions, 1);
  assert.deepEqual(visitor.complaints, []);
  await visitor.close();
});

test("a scan that is not for everybody is not on display", async () => {
  const fake = new FakeScan();
  fake.fault = 401;
  const visitor = await watched(fake);
  await visitor.page.getByRole("heading", { name: "This scan is not on display." }).waitFor();
  assert.equal(fake.questions, 1);
  await visitor.close();
});

/**
 * Waits until the model appears. Resolves to the visibility of the scan's progress bar and status
 * text at that moment.
 */
function wordsWhenModelled(page) {
  return page.evaluate(() => new Promise((done) => {
    const main = document.querySelector("main");
    const seen = (id) => getComputedStyle(document.getElementById(id)).visibility;
    new MutationObserver(() => done(["progress", "status"].map(seen))).observe(main, { attributeFilter: ["class"] });
  }));
}

/** Waits for two animation frames. By then, everything requested before has been drawn. */
function frames(page) {
  return page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

async function view(page) {
  await frames(page);
  return page.locator("#view").screenshot();
}
