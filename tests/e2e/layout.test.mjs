// SPDX-License-Identifier: Apache-2.0
// Tests the page of an object on phones that are held sideways, in print, in a right-to-left
// layout, on a slow connection, and in each language. Environment: VITRINE_BIN, VITRINE_MODEL (an
// OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { mkdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const axe = await readFile(createRequire(new URL("../../web/package.json", import.meta.url)).resolve("axe-core/axe.min.js"), "utf8");

let daemon, browser, url;

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  url = await daemon.publish(scan, "Demosthenes", "--unit", "mm", "--creator", "Polyeuktos", "--licence", "CC0-1.0");
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
});

/** Opens the object's page and waits until its tools are loaded. */
async function equipped(options) {
  const viewer = await ViewerPage.open(browser, url, options);
  await viewer.releaseLayers();
  await viewer.events("load");
  await viewer.page.locator("button[name=save]").waitFor();
  await viewer.page.getByRole("link", { name: "GLB" }).or(viewer.page.locator(".downloads")).waitFor({ state: "attached" });
  return viewer;
}

/** Returns the names of the violations that axe-core finds on the page. */
async function faults({ page }) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document));
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target).join("; ")}`);
}

const overflow = ({ page }) => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

for (const [width, height] of [[844, 390], [667, 375], [800, 320]]) {
  test(`a phone of ${width} x ${height} shows the object and all tools on one screen`, async () => {
    const viewer = await equipped({ width, height }), { page } = viewer;
    await page.screenshot({ path: join(pictures, `sideways-${width}.png`), animations: "disabled" });
    const view = await page.locator("canvas").boundingBox();
    assert.ok(view.height > height * 0.55, `the view is ${view.height} pixels high`);
    for (const tool of ["lowest", "highest", "light", "save"]) {
      const { x, y, width: w, height: h } = await page.locator(`button[name=${tool}]`).boundingBox();
      assert.ok(y + h <= height && x >= 0 && x + w <= width && h >= 43.5 && w >= 40, `${tool}: ${[x, y, w, h]}`);
    }
    await viewer.sheet("light");
    await page.locator("label:has([value=raking])").click();
    const sheet = await page.locator(".sheet:not([hidden])").boundingBox();
    assert.ok(sheet.y >= 0 && sheet.y + sheet.height <= height, `the sheet is on the screen: ${JSON.stringify(sheet)}`);
    await page.screenshot({ path: join(pictures, `sideways-${width}-light.png`), animations: "disabled" });
    assert.deepEqual([await overflow(viewer), await faults(viewer), await viewer.complaints()], [0, [], []]);
    await page.context().close();
  });
}

test("paper has the picture, the facts, how to cite them, the address and the day, but no controls", async () => {
  const viewer = await equipped({ width: 794, height: 1123 }), { page } = viewer;
  await page.emulateMedia({ media: "print" });
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  await page.screenshot({ path: join(pictures, "printed.png") });
  const day = await page.evaluate(() => new Intl.DateTimeFormat("en", { dateStyle: "medium" }).format(new Date()));
  assert.equal(await page.locator(".printed").textContent(), `${url}, viewed on ${day}.`);
  assert.ok((await page.locator(".citations").innerText()).includes("Polyeuktos. ("), "the citations are printed");
  assert.ok(await page.locator(".printed").isVisible());
  assert.ok((await page.locator("canvas").boundingBox()).height > 400);
  for (const part of [".controls", ".downloads", "#back", ".copyable >> nth=0", ".copier >> nth=0"]) assert.ok(await page.locator(part).isHidden(), part);
  const pages = (await page.pdf({ format: "A4" })).toString("latin1").match(/\/Type \/Page\b/g).length;
  assert.equal(pages, 1);
  await page.context().close();
});

test("in a page that runs from right to left, everything is mirrored, but texts run as they are written", async () => {
  const viewer = await equipped({ width: 1280, height: 800 }), { page } = viewer;
  await page.evaluate(() => (document.documentElement.dir = "rtl"));
  const left = async (place) => (await page.locator(place).boundingBox()).x;
  assert.ok(await left("button[name=lowest]") > await left("button[name=highest]"));
  assert.ok(await left("button[name=light]") > await left("button[name=save]"));
  assert.ok(await left("#about") < await left("canvas"));
  await viewer.sheet("measure");
  assert.ok(await left(".sheet:not([hidden])") < await left("button[name=light]"));
  await page.screenshot({ path: join(pictures, "right-to-left-1280.png"), animations: "disabled" });
  const hint = page.locator(".sheet:not([hidden]) .hint"), direction = await hint.evaluate((place) => getComputedStyle(place).unicodeBidi);
  assert.equal(direction, "plaintext", "the full stop stays at the end");
  assert.deepEqual([await overflow(viewer), await faults(viewer)], [0, []]);
  await page.setViewportSize({ width: 390, height: 844 });
  await page.screenshot({ path: join(pictures, "right-to-left-390.png"), animations: "disabled" });
  assert.deepEqual([await overflow(viewer), await viewer.complaints()], [0, []]);
  await page.context().close();
});

test("a slow line shows a small poster first, a fast one spares its bytes", async () => {
  const blank = await ViewerPage.open(browser, "about:blank"), { page } = blank;
  const posters = [];
  page.on("request", (request) => request.url().includes("poster.png") && posters.push(new URL(request.url()).search));
  const line = await page.context().newCDPSession(page);
  await line.send("Network.enable");
  const speed = (bytes, latency, connectionType) =>
    line.send("Network.emulateNetworkConditions", { offline: false, latency, downloadThroughput: bytes, uploadThroughput: bytes, connectionType });
  await speed(50_000, 400, "cellular3g");
  await page.goto(url, { waitUntil: "commit" });
  await page.waitForFunction(() => document.querySelector("progressive-mesh")?.shadowRoot?.querySelector(".poster").naturalWidth === 240);
  assert.ok(await page.locator("progressive-mesh .poster").isVisible());
  assert.deepEqual((await blank.seen()).filter(({ type }) => type === "first-paint"), []);
  await page.screenshot({ path: join(pictures, "slow-line.png") });
  await blank.events("first-paint");
  await page.locator("progressive-mesh .poster").waitFor({ state: "hidden" });
  assert.deepEqual(posters, ["?width=240"]);
  await speed(-1, 0, "cellular4g");
  await page.goto(url, { waitUntil: "commit" });
  await blank.events("first-paint");
  assert.deepEqual(posters, ["?width=240"]);
  await page.context().close();
});

for (const [language, word] of [["de", "Licht"], ["es", "Luz"], ["fr", "Lumière"], ["it", "Luce"]]) {
  test(`the daemon serves the texts in the language ${language}`, async () => {
    const answer = await fetch(`${daemon.url}/progressive-mesh-${language}.js`);
    assert.equal(answer.status, 200);
    const viewer = await ViewerPage.open(browser, url, { width: 390, height: 844, init: new Function(`
      Object.defineProperty(navigator, "languages", { get: () => ["${language}"] })`) });
    await viewer.page.locator(`button[name=light][title="${word}"]`).waitFor();
    assert.deepEqual(await viewer.complaints(), []);
    await viewer.page.context().close();
  });
}
