// SPDX-License-Identifier: Apache-2.0
// Tests the counts of visits: a visitor views a model on a page of another site and leaves the
// page. The console then shows the visit.
// Environment: VITRINE_BIN, VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { mkdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, newContext } from "./browser.mjs";
import { Desk, tokenFor } from "./console_desk.mjs";
import { Daemon } from "./daemon.mjs";
import { writeBlob } from "./models.mjs";
import { StaticHost } from "./static_host.mjs";

const { VITRINE_BIN: bin, VITRINE_SCREENSHOTS: pictures } = process.env;

let daemon, browser, host, api, token;

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  host = await StaticHost.start();
  const ball = join(daemon.folder, "ball.ply");
  await writeBlob(ball, 24);
  api = (await daemon.publish(ball, "A ball")).replace("/models/", "/api/v1/models/");
  token = await tokenFor(daemon, "viewer");
});

after(async () => {
  await browser?.close();
  host?.stop();
  await daemon?.stop();
});

/** Opens a page with the model in full detail. `play(page)` is called first. Returns the page, and a list of its requests. */
async function visited(play = () => undefined) {
  const context = await newContext(browser, { viewport: { width: 480, height: 400 }, reducedMotion: "reduce" });
  const page = await context.newPage(), asked = [], complaints = [];
  page.on("request", (request) => asked.push(`${request.method()} ${request.url()}`));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  await play(page);
  await page.addInitScript(() => document.addEventListener("load", ({ target }) => (window.isWhole ||= target.localName === "progressive-mesh"), true));
  await page.goto(host.page({ src: api, "pixel-error": "0", "camera-controls": "" }));
  await page.waitForFunction(() => window.isWhole && !document.querySelector("progressive-mesh").shadowRoot.querySelector(".tools").inert);
  return { page, asked, complaints, close: () => context.close() };
}

/** Returns the row of the model in the API's list of visits, once it has `visits` visits. */
async function counted(visits) {
  for (;;) {
    const { models } = await (await fetch(`${daemon.url}/api/v1/visits`, { headers: { Authorization: `Bearer ${token}` } })).json();
    if (models[0]?.visits === visits) return models[0];
  }
}

test("a visit is reported when the element is removed, and when the page is left", async () => {
  for (const [i, leave] of [(page) => page.evaluate(() => document.querySelector("progressive-mesh").remove()), (page) => page.goto("about:blank")].entries()) {
    let told;
    const asksFirst = new Promise((resolve) => (told = resolve));
    const { page, complaints, close } = await visited((opened) => opened.on("requestfinished", (request) => request.url() === api && told()));
    await asksFirst;
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    await leave(page);
    assert.equal((await counted(i + 1)).complete, i + 1);
    assert.deepEqual(complaints, []);
    await close();
  }
});

test("a visitor who does not want to be tracked is not counted", async () => {
  const { page, asked, close } = await visited((opened) => opened.addInitScript(() => Object.defineProperty(Navigator.prototype, "globalPrivacyControl", { value: true })));
  await page.evaluate(() => document.querySelector("progressive-mesh").remove());
  assert.deepEqual(asked.filter((one) => one.endsWith(api) || one.startsWith("POST")), []);
  await close();
});

test("the console shows the visits and saves them as CSV", async () => {
  const desk = await Desk.open(browser, daemon, { token }), { page } = desk;
  await desk.go("visits", "Visits");
  const cells = await page.getByRole("row").filter({ hasText: "A ball" }).getByRole("cell").allTextContents();
  assert.equal(cells[1], "2");
  assert.equal(cells.at(-1), "100 %");
  await desk.isFit("visits");
  const [download] = await Promise.all([page.waitForEvent("download"), desk.press("Save as CSV, by day")]);
  const [heads, row] = (await readFile(await download.path(), "utf8")).split("\r\n");
  assert.equal(heads, "day,model,title,visits,seconds,mean_level,complete");
  assert.match(row, /^\d{4}-\d\d-\d\d,[0-9a-z]{26},"A ball",2,\d+,[\d.]+,2$/);
  await page.getByLabel("From", { exact: true }).fill("2020-01-01");
  await page.getByLabel("To", { exact: true }).fill("2020-01-31");
  await desk.press("Show");
  await desk.says("No visits on these days.");
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});
