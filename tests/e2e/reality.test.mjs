// SPDX-License-Identifier: Apache-2.0
// Tests augmented reality: what each device starts (Scene Viewer, Quick Look or WebXR), and that the model has its real size in
// metres. Chromium imitates the devices. Environment: VITRINE_BIN, VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { mkdir, mkdtemp, readFile, rm } from "node:fs/promises";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { fakeXr } from "./fake_xr.mjs";
import { writeBlob } from "./models.mjs";

const { VITRINE_BIN: bin, VITRINE_SCREENSHOTS: pictures } = process.env;
const axe = await readFile(createRequire(new URL("../../web/package.json", import.meta.url)).resolve("axe-core/axe.min.js"), "utf8");
const kMuseum = "https://museum.example"; // URL under which pages see the daemon, because augmented reality needs HTTPS
const kAndroid = "Mozilla/5.0 (Linux; Android 14; Pixel 8) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/130.0 Mobile Safari/537.36";

let daemon, browser, folder, extent, measured, unmeasured;

before(async () => {
  await mkdir(pictures, { recursive: true });
  folder = await mkdtemp(join(tmpdir(), "vitrine-reality-"));
  daemon = await Daemon.start(bin);
  browser = await launch();
  const blob = join(folder, "blob.ply");
  await writeBlob(blob, 24);
  extent = await extentOf(blob);
  measured = new URL(await daemon.publish(blob, "A blob & more", "--unit", "cm")).pathname;
  unmeasured = new URL(await daemon.publish(blob, "Without unit")).pathname;
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
  await rm(folder, { recursive: true, force: true });
});

/** Returns the size of the mesh's bounding box along x, y and z, in the unit of the file. */
async function extentOf(ply) {
  const lines = (await readFile(ply, "utf8")).split("\n"), first = lines.indexOf("end_header") + 1;
  const vertices = lines.slice(first).map((line) => line.split(" ").map(Number)).filter((numbers) => numbers.length === 3);
  return lengths(vertices);
}

function lengths(points) {
  return [0, 1, 2].map((axis) => {
    const values = points.map((point) => point[axis]);
    return values.reduce((a, b) => Math.max(a, b)) - values.reduce((a, b) => Math.min(a, b));
  });
}

/** Opens the page of a model at kMuseum. The scripts `device` (see `devices`) and `init` run before those of the page. */
async function open(path, device, { init = () => undefined, attributes = {}, ...options } = {}) {
  const viewer = await ViewerPage.open(browser, "about:blank", { width: 390, height: 844, ...options, attributes: { transport: "http", ...attributes } });
  const { page } = viewer;
  await page.context().route(`${kMuseum}/**`, async (route) => {
    const url = route.request().url().replace(kMuseum, daemon.url);
    await route.fulfill({ response: await route.fetch({ url }) });
  });
  if (device) await page.addInitScript(device);
  await page.addInitScript(init);
  await page.goto(kMuseum + path);
  await viewer.events("load");
  await page.locator("button[name=save]").waitFor();
  return viewer;
}

/** For each device, a script that makes the browser imitate it. The script runs before those of the page. */
const devices = {
  desktop: undefined,
  phone: fakeXr,
  android: `Object.defineProperty(navigator, "userAgent", { value: ${JSON.stringify(kAndroid)} }); Object.defineProperty(navigator, "xr", { value: undefined });`,
  firefox: 'Object.defineProperty(navigator, "userAgent", { value: "Mozilla/5.0 (Android 14; Mobile; rv:132.0) Gecko/132.0 Firefox/132.0" });',
  iphone: "const { supports } = DOMTokenList.prototype; DOMTokenList.prototype.supports = function (word) { return word === 'ar' || supports.call(this, word); };",
};

const start = ({ page }) => page.locator("[name=ar-start]");

async function faults({ page }) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document));
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target).join("; ")}`);
}

const nearly = (values, expected, part = 0.01) => values.forEach((value, i) =>
  assert.ok(Math.abs(value - expected[i]) < part * expected[i], `${values} instead of ${expected}`));

/** Fetches the model file at `url`, which the viewer passes to the device. Returns its type and bytes. */
async function fetched(url) {
  assert.ok(url.startsWith(`${kMuseum}/api/v1/models/`), url);
  const answer = await fetch(url.replace(kMuseum, daemon.url));
  assert.equal(answer.status, 200);
  return { type: answer.headers.get("content-type"), bytes: Buffer.from(await answer.arrayBuffer()) };
}

const inMetres = () => extent.map((length) => length / 100);

test("a device without augmented reality, and a page that does not want it, have no button", async () => {
  for (const [device, attributes] of [["desktop", {}], ["firefox", {}]]) {
    const viewer = await open(measured, devices[device], { attributes });
    assert.equal(await viewer.page.locator("button[name=ar]").isVisible(), false, device);
    await viewer.page.context().close();
  }
  const viewer = await open(measured, devices.phone), { page } = viewer;
  await page.locator("button[name=ar]").waitFor();
  await page.locator("progressive-mesh").evaluate((element) => element.removeAttribute("ar"));
  await page.locator("button[name=ar]").waitFor({ state: "hidden" });
  await page.context().close();
});

test("Android without WebXR opens Scene Viewer with a GLB in metres, a title and a link back", async () => {
  const viewer = await open(measured, devices.android), { page } = viewer, asked = [];
  page.on("request", (request) => /-augmented/.test(request.url()) && asked.push(new URL(request.url()).pathname));
  await page.locator("button[name=ar]").waitFor();
  assert.deepEqual(asked, [], "the code is loaded on its first use");
  await viewer.sheet("ar");
  const href = await start(viewer).getAttribute("href");
  assert.deepEqual(asked, ["/progressive-mesh-augmented-reality.js"]);
  const api = `${kMuseum}/api/v1${measured}`, back = encodeURIComponent(kMuseum + measured);
  assert.equal(href, `intent://arvr.google.com/scene-viewer/1.2?file=${encodeURIComponent(`${api}/export.glb?triangles=100000`)}&mode=ar_preferred` +
    `&resizable=false&title=A+blob+%26+more&link=${back}#Intent;scheme=https;package=com.google.android.googlequicksearchbox;` +
    `action=android.intent.action.VIEW;S.browser_fallback_url=${back};end;`);
  const { type, bytes } = await fetched(new URLSearchParams(href.slice(href.indexOf("?") + 1, href.indexOf("#"))).get("file"));
  assert.equal(type, "model/gltf-binary");
  const { accessors, meshes, nodes } = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)));
  const { min, max } = accessors[meshes[0].primitives[0].attributes.POSITION], scale = nodes[0].scale ?? [1, 1, 1];
  nearly(min.map((low, i) => (max[i] - low) * scale[i]), inMetres());
  assert.deepEqual([await faults(viewer), await viewer.complaints()], [[], []]);
  await page.screenshot({ path: join(pictures, "reality-390.png"), animations: "disabled" });
  await page.context().close();
});

test("an iPhone opens Quick Look with a USDZ in metres", async () => {
  const viewer = await open(measured, devices.iphone);
  await viewer.sheet("ar");
  const link = start(viewer);
  assert.deepEqual([await link.getAttribute("rel"), await link.evaluate((element) => element.firstElementChild.localName)], ["ar", "img"]);
  const href = await link.getAttribute("href"), [file, fragment] = href.split("#");
  assert.equal(file, `${kMuseum}/api/v1${measured}/export.usdz?triangles=100000`);
  assert.equal(fragment, `allowsContentScaling=0&canonicalWebPageURL=${encodeURIComponent(kMuseum + measured)}`);
  const { type, bytes } = await fetched(file), layer = bytes.toString("latin1"); // readable as text, because a USDZ is not compressed
  assert.equal(type, "model/vnd.usdz+zip");
  const [, metres] = /metersPerUnit = ([\d.e-]+)/.exec(layer), [, low, high] = /extent = \[\(([^)]*)\),\(([^)]*)\)\]/.exec(layer);
  const [min, max] = [low, high].map((corner) => corner.split(",").map(Number));
  nearly(min.map((value, i) => (max[i] - value) * metres), inMetres());
  assert.deepEqual([await faults(viewer), await viewer.complaints()], [[], []]);
  await viewer.page.context().close();
});

test("an object of unknown size is refused with a sentence in each language", async () => {
  const viewer = await open(unmeasured, devices.android), { page } = viewer, sentences = new Set();
  for (const [language, word] of [["en", "unit"], ["de", "Einheit"], ["es", "unidad"], ["fr", "unité"], ["it", "unità"]]) {
    await page.locator("progressive-mesh").evaluate((element, tag) => (element.lang = tag), language);
    const hint = page.locator(".sheet:not([hidden]) .hint", { hasText: word });
    await page.locator("button[name=ar][aria-expanded=false]").click();
    await hint.waitFor();
    sentences.add(await hint.textContent());
    assert.equal(await start(viewer).count(), 0);
  }
  assert.equal(sentences.size, 5);
  assert.deepEqual([await faults(viewer), await viewer.complaints()], [[], []]);
  await page.screenshot({ path: join(pictures, "reality-refused.png"), animations: "disabled" });
  await page.context().close();
});

/** Runs `act(value)` in the page, where `window.phone` is the simulated phone (fake_xr.mjs). */
const phone = ({ page }, act, value) => page.evaluate(act, value);

test("WebXR stands the object on the floor at its real size, until the visitor leaves", async () => {
  const viewer = await open(measured, devices.phone), { page } = viewer, seen = () => phone(viewer, () => window.phone.seen());
  const picture = () => viewer.frames().then(() => page.locator("canvas").evaluate((canvas) => canvas.toDataURL()));
  await viewer.sheet("ar");
  assert.match(await page.locator(".sheet:not([hidden]) .size").textContent(), / × .* × .* cm$/);
  await start(viewer).waitFor();
  const before = await picture();
  await start(viewer).click();
  await page.waitForFunction(() => window.phone.session?.depths);
  assert.deepEqual(await phone(viewer, () => window.phone.asked), [{ mode: "immersive-ar", required: ["hit-test"], overlay: "room-guide" }]);
  const height = extent[1] / 100, distance = 4, across = (metres) => (metres / distance) * 200; // pixels that a length in metres covers at `distance` metres
  await phone(viewer, (y) => (window.phone.eye = [0, y, 0]), height / 2);
  assert.equal((await seen()).count, 0, "nothing stands in the air");
  await phone(viewer, (z) => Object.assign(window.phone, { floor: [0, 0, z], isWall: true }), -distance);
  assert.equal((await seen()).count, 0, "nothing stands on a wall");
  await phone(viewer, () => (window.phone.isWall = false));
  const stood = await seen();
  // The outline of a ball is a little larger than its diameter at the distance of its centre.
  const radius = height / 2, outline = across(2 * radius) / Math.sqrt(1 - (radius / distance) ** 2);
  nearly([stood.top - stood.bottom + 1, stood.right - stood.left + 1, (stood.top + stood.bottom) / 2, (stood.left + stood.right) / 2], [outline, outline, 200, 200], 0.04);
  assert.ok(stood.light > 60, `lit: ${stood.light}`);
  await phone(viewer, () => window.phone.tap());
  await phone(viewer, () => (window.phone.floor = [1, 0, -4]));
  assert.deepEqual(await seen(), stood, "it stays where it was set down");
  await phone(viewer, () => window.phone.tap());
  nearly([(await seen()).right - stood.right], [across(1)], 0.15);
  await phone(viewer, () => (window.phone.eye[2] = 4));
  nearly([(await seen()).top - (await seen()).bottom], [outline / 2], 0.06);
  assert.ok(await page.locator(".room-guide").isVisible());
  assert.deepEqual(await faults(viewer), []);
  await page.screenshot({ path: join(pictures, "reality-guide.png"), animations: "disabled" });
  await page.locator(".room-guide").getByRole("button", { name: "Close" }).click();
  await page.locator(".room-guide").waitFor({ state: "hidden" });
  assert.ok((await picture()) === before, "the viewer is as before");
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});

test("if the phone refuses the session, a sentence says so", async () => {
  const viewer = await open(measured, devices.phone), { page } = viewer;
  await phone(viewer, () => (window.phone.refusal = "NotSupportedError"));
  await viewer.sheet("ar");
  await start(viewer).click();
  await page.locator(".sheet .hint", { hasText: "cannot be started" }).waitFor();
  assert.equal(await page.locator(".room-guide").isVisible(), false);
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});
