// SPDX-License-Identifier: Apache-2.0
// Who watches an object being measured, in a real browser: the scan itself is played, page and model
// are the daemon's. Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS.
import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { FakeScan, kScan, measured } from "./fake_scan.mjs";
import { readObj } from "./models.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const kPoints = 120_000;

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

/** A page that watches a scan. */
async function watched(fake, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1100, height: 760 }, ...options });
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
    await settled(visitor.page);
    await visitor.shoot(`growing-${100 * share}`);
  }
  await visitor.says("about a minute left");
  fake.tell({ state: "meshing", step: 720, progress: 0.85, eta: 8 }, points);
  await visitor.says("Joining the points to a surface");
  await visitor.says("a few seconds left");
  await visitor.shoot("meshing");

  const held = [];
  await visitor.page.context().route("**/api/v1/models/*/stream", (route) => route.abort());
  await visitor.page.context().route("**/api/v1/chunks/*", (route) => void held.push(route));
  fake.tell({ state: "done", progress: 1, eta: null, model });
  await visitor.page.locator("main.modelled").waitFor();
  await visitor.page.locator("#growth").waitFor({ state: "hidden" });
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

/** The camera has come to rest: two pictures in turn are alike. Needs a page that does not turn by itself. */
async function settled(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}
