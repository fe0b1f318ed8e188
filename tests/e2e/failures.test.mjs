// SPDX-License-Identifier: Apache-2.0
// Tests failures: a visitor keeps the last good picture and sees a message.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan } = process.env;

let daemon, browser, url, faces;

before(async () => {
  daemon = await Daemon.start(bin);
  browser = await launch();
  url = await daemon.publish(scan, "Demosthenes");
  faces = (await (await fetch(`${url.replace("/models/", "/api/v1/models/")}/manifest`)).json()).levels.at(-1).faces;
});
after(async () => {
  await browser?.close();
  await daemon?.stop();
});

const shown = (viewer) => viewer.seen().then((seen) => seen.filter(({ type }) => type === "refine").map(({ detail }) => detail.triangles));
const message = (viewer) => viewer.page.locator("progressive-mesh [role=alert]");
const src = (viewer, address) => viewer.page.locator("progressive-mesh").evaluate((element, to) => element.setAttribute("src", to), address);

for (const transport of ["http", "ws"]) {
  test(`resumes where it was when the server died in mid-stream and came back, by ${transport}`, async () => {
    const viewer = await ViewerPage.open(browser, url, { attributes: { "pixel-error": "0", "max-triangles": "0", transport } });
    viewer.holding = false;
    await viewer.events("load");
    const base = (await shown(viewer)).at(-1);
    await daemon.kill();
    await viewer.page.locator("progressive-mesh").evaluate((element) => element.removeAttribute("max-triangles"));
    await message(viewer).filter({ hasText: "cannot be reached" }).waitFor();
    assert.equal((await shown(viewer)).at(-1), base, "what there is stays");
    await daemon.startAgain();
    await viewer.events("load", 2);
    const states = await shown(viewer);
    assert.equal(states.at(-1), faces);
    assert.deepEqual(states, [...states].sort((a, b) => a - b), "it never starts over");
    assert.equal(await message(viewer).isVisible(), false);
    assert.deepEqual(await viewer.events("error", 0), []);
    await viewer.page.context().close();
  });
}

test("fetches a corrupt chunk once more, then names it and keeps what it has", async () => {
  const viewer = await ViewerPage.open(browser, url, { attributes: { "pixel-error": "0", transport: "http" } });
  const asked = new Map();
  let spoilt;
  await viewer.page.context().route("**/api/v1/chunks/*", async (route) => {
    const address = route.request().url();
    asked.set(address, (asked.get(address) ?? 0) + 1);
    if (asked.size === 4) spoilt ??= address;
    const response = await route.fetch();
    const body = await response.body();
    if (address === spoilt) body[body.length >> 1] ^= 1;
    return route.fulfill({ response, body });
  });
  const [{ detail }] = await viewer.events("error");
  assert.match(detail.message, /the chunk of level \d+, region \d+ does not match its SHA-256/);
  assert.equal(asked.get(spoilt), 2);
  const states = await shown(viewer);
  assert.ok(states.at(-1) > states[0] && states.at(-1) < faces, "the last good level");
  assert.equal(await message(viewer).textContent(), detail.message);
  await viewer.page.context().close();
});

test("starts a decoder that has crashed again, behind what is shown", async () => {
  const viewer = await ViewerPage.open(browser, url);
  viewer.holding = false;
  await viewer.releaseLayers();
  await viewer.events("load");
  const [worker] = viewer.page.workers();
  await worker.evaluate(() => void setTimeout(() => { throw new Error("the decoder is gone"); }));
  await viewer.events("load", 1);
  await viewer.settled(() => viewer.page.locator("progressive-mesh").evaluate((element) => element.setAttribute("max-triangles", "5000")));
  const states = await shown(viewer);
  assert.ok(states.at(-1) <= 5000 && states.at(-1) > 4500);
  assert.deepEqual(states.slice(states.indexOf(faces)).filter((count) => count < 4500), [], "no picture of the base mesh in between");
  assert.equal(viewer.page.workers().length, 1);
  assert.deepEqual(await viewer.events("error", 0), []);
  await viewer.page.context().close();
});

test("shows the poster and says why where WebGL is missing", async () => {
  const viewer = await ViewerPage.open(browser, url, {
    attributes: { poster: `${url.replace("/models/", "/api/v1/models/")}/poster.png` },
    init: () => (HTMLCanvasElement.prototype.getContext = () => null),
  });
  await viewer.events("error");
  assert.match(await message(viewer).textContent(), /cannot show three-dimensional content/);
  assert.ok(await viewer.page.locator("progressive-mesh .poster").isVisible());
  await viewer.page.context().close();
});

test("says that a model is not there", async () => {
  const viewer = await ViewerPage.open(browser, url);
  await viewer.events("first-paint");
  await src(viewer, "/api/v1/models/nothing-of-this-name");
  const [{ detail }] = await viewer.events("error");
  assert.match(detail.message, /is not there \(404\)/);
  assert.equal(await message(viewer).textContent(), detail.message);
  await viewer.page.context().close();
});
