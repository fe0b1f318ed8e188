// SPDX-License-Identifier: Apache-2.0
// Tests how visitors and other sites share an object: the system's dialog, links, QR codes, and the code that embeds it.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { mkdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { StaticHost } from "./static_host.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const library = (path) => readFile(createRequire(new URL("../../web/package.json", import.meta.url)).resolve(path), "utf8");
const [axe, jsqr] = await Promise.all([library("axe-core/axe.min.js"), library("jsqr/dist/jsQR.js")]);
const kNotes = [{ position: [0, 0, 0], normal: [1, 0, 0], title: "Ear", text: "Restored." }, { position: [0, 0.4, 0], title: "Crown" }];

let daemon, browser, url, site;

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  url = await daemon.publish(scan, "Demosthenes", "--unit", "mm");
  site = await StaticHost.start();
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
  site?.stop();
});

/** Opens the object's page, which has two notes, and waits until the requested detail is shown. */
async function open({ fragment = "", ...options } = {}) {
  const viewer = await ViewerPage.open(browser, "about:blank", { ...options, attributes: { "pixel-error": "0", annotations: "/notes.json" } });
  await viewer.page.context().route("**/notes.json", (route) => route.fulfill({ json: kNotes }));
  await viewer.releaseLayers();
  await viewer.page.goto(url + fragment);
  await viewer.events("load");
  await viewer.page.locator("button[name=notes]").waitFor();
  return viewer;
}

async function faults({ page }) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document));
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target).join("; ")}`);
}

/** Returns a hash of the canvas's picture. */
async function drawn(viewer) {
  await viewer.frames();
  const picture = await viewer.page.locator("canvas").evaluate((canvas) => canvas.toDataURL());
  return createHash("sha256").update(picture).digest("hex");
}

/** Runs in the page: replaces the system's dialog for sharing. Records each shared content, and throws the error `window.refusal` if it is set. */
function offerSharing() {
  window.shared = [];
  navigator.share = async (content) => {
    window.shared.push(content);
    if (window.refusal) throw new DOMException("", window.refusal);
  };
}

/** Presses "Share…". Returns the content that the system's dialog has received. */
async function share({ page }) {
  await page.getByRole("button", { name: "Share…" }).click();
  return page.evaluate(() => window.shared.at(-1));
}

test("the system's dialog gets a link that keeps view, light, section, surface, shadow, note and level", async () => {
  const viewer = await open({ init: offerSharing }), { page } = viewer;
  await viewer.sheet("notes");
  await page.locator(".notes").getByRole("button", { name: "Crown" }).click();
  await viewer.sheet("light");
  await page.locator("label:has([value=raking])").click();
  await page.locator("input[name=shadow]").check();
  await viewer.sheet("section");
  await page.locator("label:has([value=y])").click();
  await viewer.sheet("surface");
  await page.locator("input[name=facets]").check();
  await viewer.settled(() => page.locator("button[name=lowest]").click());
  for (let i = 0; i < 3; ++i) await page.locator("canvas").press("ArrowLeft");
  await viewer.sheet("save");
  const { title, url: link } = await share(viewer), words = new URLSearchParams(new URL(link).hash.slice(1));
  assert.equal(title, "Demosthenes");
  assert.deepEqual([...words.keys()].sort(), ["detail", "light", "note", "section", "shadow", "surface", "view"]);
  assert.deepEqual([words.get("note"), words.get("light"), words.get("section")], ["2", "raking,315", "y,100"]);
  const other = await open({ init: offerSharing, fragment: new URL(link).hash });
  assert.equal(await other.page.locator(".notes [aria-current]").textContent(), "Crown");
  assert.equal(await other.triangles(), await viewer.triangles());
  await page.evaluate((hash) => (location.hash = hash), new URL(link).hash); // opens the link here too, because a link rounds angles
  const picture = await drawn(viewer);
  for (let i = 0; i < 100 && (await drawn(other)) !== picture; ++i) await other.frames(); // waits until the script for the shadow is loaded
  assert.equal(await drawn(other), picture);
  await other.sheet("save");
  assert.equal((await share(other)).url, link);
  assert.deepEqual([await viewer.complaints(), await other.complaints()], [[], []]);
  await Promise.all([viewer, other].map(({ page }) => page.context().close()));
});

test("if the browser refuses the dialog, the link is copied; if the visitor closes it, nothing happens", async () => {
  const viewer = await open({ init: offerSharing }), { page } = viewer;
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await viewer.sheet("save");
  const copied = page.locator(".sheet .hint", { hasText: "Link copied." });
  await page.evaluate(() => (window.refusal = "AbortError"));
  await share(viewer);
  assert.equal(await copied.count(), 0);
  await page.evaluate(() => (window.refusal = "NotAllowedError"));
  const { url: link } = await share(viewer);
  await copied.waitFor();
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), link);
  await page.context().close();
});

test("without such a dialog, the link can be copied by hand", async () => {
  const viewer = await open({ init: () => Object.defineProperty(navigator, "clipboard", { value: undefined }) }), { page } = viewer;
  await viewer.sheet("save");
  assert.equal(await page.getByRole("button", { name: "Share…" }).isVisible(), false);
  await page.locator(".sheet:not([hidden])").getByRole("button", { name: "Copy" }).click();
  await page.locator(".sheet .hint", { hasText: "copy it with the keyboard" }).waitFor();
  const selected = await page.evaluate(() => {
    const { value, selectionStart, selectionEnd } = document.activeElement.shadowRoot.activeElement;
    return value.slice(selectionStart, selectionEnd);
  });
  assert.ok(selected.startsWith(`${url}#view=`), selected);
  await page.context().close();
});

/** Reads the QR code on the screen, as a phone's camera would. */
async function scanned({ page }) {
  const png = await page.locator(".qr svg").screenshot({ animations: "disabled" });
  const reader = await page.context().newPage();
  await reader.evaluate(jsqr);
  const text = await reader.evaluate(async (source) => {
    const bitmap = await createImageBitmap(await (await fetch(source)).blob()), { width, height } = bitmap;
    const context = new OffscreenCanvas(width, height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    return window.jsQR(context.getImageData(0, 0, width, height).data, width, height)?.data;
  }, `data:image/png;base64,${png.toString("base64")}`);
  await reader.close();
  return text;
}

for (const [width, height, colorScheme] of [[390, 844, "dark"], [1440, 900, "light"]]) {
  test(`at ${width} x ${height}, a QR code has the link, also after the view has changed`, async () => {
    const viewer = await open({ width, height, colorScheme }), { page } = viewer, asked = [];
    page.on("request", (request) => asked.push(new URL(request.url()).pathname));
    await viewer.sheet("save");
    const link = () => page.locator("input[name=link]").inputValue(), first = await link();
    assert.ok(!asked.includes("/progressive-mesh-qr-code.js"), "its code is loaded on its first use");
    await page.getByRole("button", { name: "QR code" }).click();
    await page.getByRole("img", { name: "QR code of the link" }).waitFor();
    assert.ok(asked.includes("/progressive-mesh-qr-code.js"));
    assert.equal(await scanned(viewer), first);
    assert.deepEqual(await faults(viewer), []);
    await page.screenshot({ path: join(pictures, `sharing-qr-${width}.png`), animations: "disabled" });
    const code = await page.locator(".qr path").getAttribute("d");
    await page.locator("canvas").press("ArrowLeft");
    assert.notEqual(await link(), first);
    await page.waitForFunction((before) => document.querySelector("progressive-mesh").shadowRoot.querySelector(".qr path").getAttribute("d") !== before, code);
    assert.equal(await scanned(viewer), await link());
    assert.deepEqual(await viewer.complaints(), []);
    await page.context().close();
  });
}

/** Returns the HTML that the object's page offers for embedding: one text with the element, and one with a frame. */
async function offeredCode() {
  const viewer = await ViewerPage.open(browser, url);
  const fields = viewer.page.getByRole("textbox", { name: "Embed" });
  await fields.nth(1).waitFor();
  const texts = await Promise.all((await fields.all()).map((field) => field.inputValue()));
  await viewer.page.context().close();
  return texts;
}

/** Opens a page of another origin whose text contains the HTML `code`. */
async function pasted(name, code, options) {
  const words = `<h1>Diary</h1><p>Seen today:</p>${code}<p>Tomorrow more.</p>`;
  const page = site.add(name, `<!doctype html><html lang="en"><meta name="viewport" content="width=device-width"><title>Diary</title><link rel="icon" href="data:,"><main>${words}</main></html>`);
  const viewer = await ViewerPage.open(browser, page, { ...options, attributes: {} });
  await viewer.releaseLayers();
  return viewer;
}

/** Drags across the middle of a canvas, and returns by which angle the object has turned. `within` is the page or a frame. */
async function turned(page, within) {
  const orbit = () => within.locator("progressive-mesh").evaluate((element) => element.getCameraOrbit()?.theta);
  await within.locator("progressive-mesh .controls.ready").waitFor();
  const before = await orbit(), { x, y, width, height } = await within.locator("canvas").boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + 80, y + height / 2, { steps: 4 });
  await page.mouse.up();
  return (await orbit()) - before;
}

const nearly = (value, expected) => assert.ok(Math.abs(value - expected) < 0.02 * expected, `${value} instead of ${expected}`);

for (const [width, height] of [[390, 844], [1440, 900]]) {
  test(`at ${width} x ${height}, the code that a page offers shows an object that can be turned on another site`, async () => {
    const [code] = await offeredCode(), viewer = await pasted("element.html", code, { width, height }), { page } = viewer;
    await viewer.events("load");
    const box = await page.locator("progressive-mesh").boundingBox();
    nearly(box.width / box.height, 4 / 3);
    assert.ok(Math.abs(await turned(page, page)) > 0.2);
    assert.ok((await page.locator("canvas").boundingBox()).height > 0.6 * box.height, "the picture has most of the place");
    const poster = await page.locator("progressive-mesh").getAttribute("poster");
    assert.match(new URL(poster).origin, /127/);
    assert.equal(await page.evaluate(async (source) => {
      const image = new Image();
      image.src = source;
      await image.decode();
      return image.naturalWidth;
    }, poster), 960);
    assert.deepEqual([await faults(viewer), await viewer.complaints()], [[], []]);
    await page.screenshot({ path: join(pictures, `sharing-embedded-${width}.png`), animations: "disabled", fullPage: true });
    await page.context().close();
  });

  test(`at ${width} x ${height}, the frame that a page offers shows an object that can be turned on another site`, async () => {
    const [, code] = await offeredCode(), viewer = await pasted("frame.html", code, { width, height }), { page } = viewer;
    const frame = page.frameLocator("iframe"), box = await page.locator("iframe").boundingBox();
    nearly(box.width / box.height, 4 / 3);
    assert.ok(Math.abs(await turned(page, frame)) > 0.2);
    assert.equal(await frame.locator("#about").isVisible(), false, "the object alone");
    assert.equal(await frame.locator("html").evaluate((root) => root.scrollHeight - root.clientHeight), 0, "nothing to scroll");
    assert.equal(await frame.locator("canvas").evaluate((canvas) => canvas.style.touchAction), "pan-y", "swipes scroll the other site");
    assert.ok((await frame.locator("canvas").boundingBox()).height > 0.6 * box.height, "the picture has most of the frame");
    const [collection] = await Promise.all([page.context().waitForEvent("page"), frame.locator("#back").click()]);
    await collection.waitForURL(`${daemon.url}/`);
    await collection.close();
    assert.deepEqual([await faults(viewer), await viewer.complaints()], [[], []]);
    await page.screenshot({ path: join(pictures, `sharing-framed-${width}.png`), animations: "disabled", fullPage: true });
    await page.context().close();
  });
}
