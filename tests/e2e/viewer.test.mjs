// SPDX-License-Identifier: Apache-2.0
// Tests the viewer page as a visitor uses it, in a real browser with the real daemon.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS.
import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { isDeepStrictEqual } from "node:util";
import { ViewerPage, launch, newContext } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { readObj, writeColoured } from "./models.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;

let daemon, browser, mesh;
const pages = {};

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  mesh = await readObj(scan);
  const coloured = join(daemon.folder, "coloured.ply");
  await writeColoured(mesh, coloured);
  pages.plain = await daemon.publish(scan, "Demosthenes");
  pages.coloured = await daemon.publish(coloured, "Demosthenes, coloured");
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
});

test("pages run nothing that somebody has written into a title", async () => {
  const { headers } = await fetch(pages.plain);
  assert.doesNotMatch(headers.get("content-security-policy"), /unsafe-inline/);
  assert.match(headers.get("content-security-policy"), /^default-src 'self'; script-src 'self' 'wasm-unsafe-eval';/);
});

for (const kind of ["plain", "coloured"]) {
  describe(`the ${kind} model`, () => {
    let viewer;
    const picture = (name) => viewer.picture(join(pictures, `${kind}-${name}.png`));

    before(async () => (viewer = await ViewerPage.open(browser, pages[kind])));
    after(() => viewer?.page.context().close());

    test("paints the base mesh before any enhancement layer has arrived", async () => {
      await viewer.events("first-paint");
      const seen = await viewer.seen();
      const paint = seen.findIndex(({ type }) => type === "first-paint");
      const shown = seen.slice(0, paint).filter(({ type }) => type === "refine");
      assert.equal(shown.length, 1);
      assert.ok(shown[0].detail.triangles < mesh.faces.length / 10);
      assert.equal(viewer.finishedChunks, 0);
      assert.match(await viewer.counts(), /^[1-9][\d,]* of [\d,]+ triangles$/);
      const base = await picture("base");
      assert.ok(await differs(viewer, base), "the canvas shows something");
      assert.equal(viewer.finishedChunks, 0);
    });

    test("sharpens to every triangle of the source", async () => {
      const [before] = await viewer.events("refine");
      await viewer.releaseLayers();
      await viewer.events("load");
      assert.equal(await viewer.triangles(), mesh.faces.length);
      assert.ok(viewer.askedChunks > 0);
      assert.ok(before.detail.triangles < mesh.faces.length);
      const number = new Intl.NumberFormat("en").format(mesh.faces.length);
      assert.equal(await viewer.counts(), `${number} of ${number} triangles`);
      await picture("full");
    });

    test("goes coarser and finer with the slider", async () => {
      const asked = viewer.askedChunks;
      await viewer.slide(0);
      const base = await viewer.triangles();
      await viewer.slide(0.6);
      const wanted = Math.round(base * (mesh.faces.length / base) ** 0.6);
      const middle = await viewer.triangles();
      assert.ok(middle <= wanted && middle >= 0.9 * wanted, `${middle} triangles for ${wanted}`);
      await picture("mid");
      await viewer.slide(1);
      assert.equal(await viewer.triangles(), mesh.faces.length);
      assert.equal(viewer.askedChunks, asked, "nothing is fetched twice");
    });

    for (const toggle of ["facets", "wireframe"]) {
      test(`shows ${toggle} and takes them back`, async () => {
        const box = await viewer.toggle(toggle);
        const plain = await canvas(viewer);
        await box.check();
        const changed = await canvas(viewer, `${kind}-${toggle}`);
        assert.notDeepEqual(changed, plain);
        await box.uncheck();
        assert.deepEqual(await canvas(viewer), plain);
      });
    }

    test("offers the form alone only where there are colours", async () => {
      const box = await viewer.toggle("form");
      assert.equal(await box.isVisible(), kind === "coloured");
      if (kind === "plain") return;
      const coloured = await canvas(viewer);
      await box.check();
      assert.notDeepEqual(await canvas(viewer), coloured);
      await box.uncheck();
      assert.deepEqual(await canvas(viewer), coloured);
    });

    test("turns with the pointer and tells the page", async () => {
      const box = await viewer.page.locator("progressive-mesh").boundingBox();
      const still = await canvas(viewer);
      const moves = (await viewer.seen()).filter(({ type }) => type === "camera-change").length;
      await viewer.page.mouse.move(box.x + box.width / 2, box.y + box.height / 3);
      await viewer.page.mouse.down();
      await viewer.page.mouse.move(box.x + box.width / 3, box.y + box.height / 3, { steps: 4 });
      await viewer.page.mouse.up();
      await viewer.events("camera-change", moves + 1);
      assert.notDeepEqual(await canvas(viewer), still);
    });

    test("leaves no error in the console", async () => assert.deepEqual(await viewer.complaints(), []));
  });
}

test("the gallery lists what is published", async () => {
  const viewer = await ViewerPage.open(browser, daemon.url);
  await viewer.page.locator("#models li").nth(1).waitFor();
  assert.ok(await viewer.page.getByRole("link", { name: "Demosthenes, coloured" }).isVisible());
  await viewer.page.screenshot({ path: join(pictures, "gallery.png") });
  assert.equal(await viewer.page.locator("#models li").count(), 2);
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
});

test("a page reads without JavaScript, and an address without an object says so", async () => {
  const context = await newContext(browser, { javaScriptEnabled: false, viewport: { width: 390, height: 844 } }), page = await context.newPage();
  await page.goto(pages.plain);
  for (const name of ["Demosthenes", "About this object"]) await page.getByRole("heading", { name }).waitFor();
  await page.locator("dd", { hasText: "triangles" }).waitFor();
  const poster = page.getByRole("img", { name: "Demosthenes" });
  await poster.waitFor();
  assert.ok((await poster.boundingBox()).width > 200);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0);
  for (const width of [390, 1440]) {
    await page.setViewportSize({ width, height: 844 });
    await page.screenshot({ path: join(pictures, `no-script-${width}.png`) });
  }
  await page.goto(daemon.url);
  await page.getByRole("heading", { level: 1, name: "Collection" }).waitFor();
  const cards = page.locator("#models li");
  assert.equal(await cards.count(), 2);
  for (const width of [1440, 390]) {
    await page.setViewportSize({ width, height: 844 });
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0);
    await page.screenshot({ path: join(pictures, `gallery-no-script-${width}.png`) });
  }
  await cards.getByRole("link", { name: "Demosthenes", exact: true }).click();
  await page.getByRole("heading", { level: 1, name: "Demosthenes" }).waitFor();
  const answer = await page.goto(`${daemon.url}/models/01hf0000000000000000000000`);
  assert.equal(answer.status(), 404);
  await page.getByRole("link", { name: "To the collection" }).waitFor();
  await page.screenshot({ path: join(pictures, "not-found-1440.png") });
  await page.setViewportSize({ width: 390, height: 844 });
  await page.screenshot({ path: join(pictures, "not-found-390.png") });
  assert.equal((await page.goto(`${daemon.url}/api/v1/jobs`)).status(), 401);
  await page.getByRole("link", { name: "To the console" }).waitFor();
  await context.close();
});

test("a browser without WebGL shows the poster and says what is missing", async () => {
  const viewer = await ViewerPage.open(browser, pages.plain, { init: () => (HTMLCanvasElement.prototype.getContext = () => null) });
  await viewer.page.getByText("WebGL 2 is missing").waitFor();
  await viewer.page.waitForFunction(() => document.querySelector("progressive-mesh").shadowRoot.querySelector(".poster").naturalWidth === 960);
  assert.ok(await viewer.page.locator("progressive-mesh .poster").isVisible());
  await viewer.page.screenshot({ path: join(pictures, "no-webgl.png") });
  await viewer.page.context().close();
});

test("an open surface is seen from behind, too", async () => {
  const away = join(daemon.folder, "away.ply");
  const corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
  await writeColoured({ vertices: corners, faces: [[0, 2, 1], [0, 3, 2]] }, away);
  const viewer = await ViewerPage.open(browser, await daemon.publish(away, "A sheet that faces away"));
  await viewer.releaseLayers();
  await viewer.events("load");
  assert.ok(await differs(viewer, await viewer.picture()), "the canvas shows something");
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
});

test("is drawn whatever display the page gives the element", async () => {
  const viewer = await ViewerPage.open(browser, pages.plain);
  // The page's content security policy forbids style elements, but scripts may set style
  // properties.
  const style = (text) => viewer.page.locator("progressive-mesh").evaluate((element, css) => void (element.style.cssText = css), text);
  await viewer.events("first-paint");
  for (const display of ["block", "inline-block", "grid"]) {
    await style(`display: ${display}; flex: none; width: 400px; height: 400px`);
    const { width, height } = await viewer.page.locator("progressive-mesh canvas").boundingBox();
    assert.equal(width, 400, display);
    assert.ok(height > 250, `${display}: ${height}`);
  }
  await style("display: inline-block; flex: none; width: auto");
  const { width } = await viewer.page.locator("progressive-mesh canvas").boundingBox();
  assert.ok(width >= 280, `without a width: ${width}`);
  await viewer.page.context().close();
});

test("a page for a narrow, dark screen shows the whole model", async () => {
  const viewer = await ViewerPage.open(browser, pages.coloured, { colorScheme: "dark", width: 360, height: 640 });
  await viewer.releaseLayers();
  await viewer.events("load");
  // Waits for the title, because the layout changes when the title arrives.
  await viewer.page.getByRole("heading", { name: "Demosthenes, coloured" }).waitFor();
  await viewer.page.screenshot({ path: join(pictures, "narrow-dark.png"), animations: "disabled" });
  const overflow = await viewer.page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.equal(overflow, 0);
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
});

test("the stream brings the whole model without a request for a chunk", async () => {
  const viewer = await ViewerPage.open(browser, `${pages.coloured}?transport=ws`);
  await viewer.events("load");
  assert.equal(await viewer.triangles(), mesh.faces.length);
  assert.equal(viewer.askedChunks, 0);
  await viewer.slide(0);
  await viewer.slide(1);
  assert.equal(await viewer.triangles(), mesh.faces.length);
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
});

test("draws again when a lost WebGL context comes back", async () => {
  const viewer = await refined(pages.plain);
  const before = await canvas(viewer);
  await viewer.loseContext();
  // Polls, because the surface is uploaded to the new context in several steps.
  await until(async () => isDeepStrictEqual(await canvas(viewer), before));
  await viewer.page.context().close();
});

test("another src keeps the visitor's switches, and attributes may change while it loads", async () => {
  const viewer = await refined(pages.plain);
  await (await viewer.toggle("wireframe")).check();
  await viewer.settled(() => viewer.page.evaluate((src) => {
    const element = document.querySelector("progressive-mesh");
    element.src = src;
    element.setAttribute("max-triangles", "1000");
    element.removeAttribute("max-triangles");
  }, pages.coloured));
  assert.equal(await viewer.triangles(), mesh.faces.length);
  const wired = await canvas(viewer);
  await (await viewer.toggle("wireframe")).uncheck();
  assert.notDeepEqual(await canvas(viewer), wired);
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
});

test("says so when the page forbids its worker", async () => {
  const viewer = await ViewerPage.open(browser, pages.plain, { init: () => {
    window.Worker = class {
      postMessage() {
        setTimeout(() => this.onerror?.(new ErrorEvent("error", { cancelable: true })));
      }
      terminate() {}
    };
  } });
  const [{ detail }] = await viewer.events("error");
  assert.match(detail.message, /decoder stopped: reload/);
  assert.equal(await viewer.page.locator("progressive-mesh [role=alert]").textContent(), detail.message);
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
});

/**
 * Opens a page and waits until all requested detail is shown. By default, the page requests the
 * whole model; `attributes` may request less.
 */
async function refined(url, attributes) {
  const viewer = await ViewerPage.open(browser, url, { attributes });
  await viewer.events("first-paint");
  await viewer.releaseLayers();
  await viewer.events("load");
  return viewer;
}

test("with a pixel error the camera decides what is fetched", async () => {
  const viewer = await refined(pages.plain, { "pixel-error": "8" });
  const far = await viewer.triangles(), asked = viewer.askedChunks;
  assert.ok(far < mesh.faces.length, "the whole is not needed from afar");
  const box = await viewer.page.locator("progressive-mesh").boundingBox();
  await viewer.page.mouse.move(box.x + box.width / 2, box.y + box.height / 3);
  // Moves the camera near the model, so that more detail becomes visible.
  await viewer.sharpened(far, () => viewer.page.mouse.wheel(0, -4000));
  assert.ok(viewer.askedChunks > asked);
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
});

test("with a pixel error a larger view asks for more", async () => {
  const viewer = await refined(pages.plain, { "pixel-error": "8" });
  const small = await viewer.triangles();
  const { width, height } = viewer.page.viewportSize();
  await viewer.sharpened(small, () => viewer.page.setViewportSize({ width: 2 * width, height: 2 * height }));
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
});

test("the far side of the surface does not speckle its outline", async () => {
  const viewer = await refined(pages.plain);
  await viewer.frames();
  const { edges, dark } = await viewer.page.locator("progressive-mesh canvas").evaluate((canvas) => {
    const gl = canvas.getContext("webgl2"), { width, height } = canvas, data = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
    const seen = { edges: 0, dark: 0 };
    for (let y = 0; y < height; ++y) {
      const end = 4 * width * (y + 1);
      let at = end - 4 * width;
      while (at < end && data[at + 3] === 0) at += 4;
      // Skips rows without a surface, and rows without a partly covered pixel at the surface's
      // edge.
      if (at === end || data[at + 3] === 255) continue;
      const edge = (255 * data[at]) / data[at + 3];
      while (data[at + 3] < 255) at += 4;
      ++seen.edges;
      if (edge < 0.8 * data[at + 4]) ++seen.dark;
    }
    return seen;
  });
  assert.ok(edges > 100 && dark < edges / 5, `${dark} of ${edges} pixels are darker than the surface within`);
  await viewer.page.context().close();
});

test("the code of a first visit travels packed, in less than half of its bytes", async () => {
  const viewer = await refined(pages.plain);
  const code = await viewer.page.evaluate(() => performance.getEntriesByType("resource").filter(({ name }) => /\.(js|css|wasm)$/.test(name))
    .map(({ name, encodedBodySize: sent, decodedBodySize: read }) => ({ name, sent, read })));
  assert.deepEqual(code.filter(({ sent, read }) => sent === 0 || sent >= read), []);
  const [sent, read] = ["sent", "read"].map((what) => code.reduce((sum, one) => sum + one[what], 0));
  console.log(`${code.length} files of code: ${sent} bytes for ${read}`);
  assert.ok(sent < read / 2, `${sent} bytes for ${read}`);
  await viewer.page.context().close();
});

/** Polls until `holds` resolves to true. Only the timeout of the whole test ends the polling. */
async function until(holds) {
  while (!(await holds()));
}

/**
 * Returns a hash of the picture in the viewer's upper half, which has no controls. Saves the
 * picture if `name` is given.
 */
async function canvas(viewer, name) {
  const bytes = await viewer.picture(name && join(pictures, `${name}.png`));
  return crop(viewer, bytes);
}

/**
 * Returns the SHA-256 of the pixels in the upper half of a picture. The panel and the sheet are in
 * the lower half.
 */
function crop(viewer, png) {
  return viewer.page.evaluate(async (base64) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))]));
    const surface = new OffscreenCanvas(image.width, Math.floor(image.height * 0.5));
    const context = surface.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, surface.width, surface.height);
    const digest = await crypto.subtle.digest("SHA-256", data);
    return Array.from(new Uint8Array(digest));
  }, png.toString("base64"));
}

/** Returns whether a picture shows more than the smooth background: its centre must differ from its corner. */
function differs(viewer, png) {
  return viewer.page.evaluate(async (base64) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))]));
    const surface = new OffscreenCanvas(image.width, image.height);
    const context = surface.getContext("2d");
    context.drawImage(image, 0, 0);
    const at = (x, y) => context.getImageData(x, y, 1, 1).data;
    const middle = at(image.width / 2, image.height * 0.45), corner = at(3, 3);
    return [0, 1, 2].some((i) => Math.abs(middle[i] - corner[i]) > 12);
  }, png.toString("base64"));
}
