// SPDX-License-Identifier: Apache-2.0
// Tests models with a picture, on a ball with stripes that vertex colours alone could not show.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { promisify } from "node:util";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { countWebGl } from "./memory.mjs";
import { writeStripedBall } from "./models.mjs";
import { StaticHost } from "./static_host.mjs";

const { VITRINE_BIN: bin, VITRINE_SCREENSHOTS: pictures } = process.env;
const kStripes = 48;

let daemon, browser, host, ball;

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  host = await StaticHost.start();
  ball = join(daemon.folder, "ball.glb");
  const pmesh = join(daemon.folder, "ball.pmesh");
  await writeStripedBall(ball, { stripes: kStripes });
  await promisify(execFile)(join(bin, "vitrine"), ["build", ball, "-o", pmesh]);
  for (const name of ["ball.pmesh", "other.pmesh"]) host.add(name, await readFile(pmesh));
});

after(async () => {
  await browser?.close();
  host?.stop();
  await daemon?.stop();
});

/** Returns the number of requests for the model so far. */
const fetches = () => host.asked.filter((line) => line.startsWith("GET /ball.pmesh")).length;

const open = (attributes = {}, options = {}) => ViewerPage.open(browser, host.page({ src: `${host.url}/ball.pmesh`, ...attributes }), options);

/** Counts how often the colour changes between red and blue along the middle row of the canvas. Other colours do not count. */
async function stripes(viewer) {
  await viewer.frames();
  return viewer.page.locator("progressive-mesh").evaluate((element) => {
    const canvas = element.shadowRoot.querySelector("canvas"), { width, height } = canvas;
    const context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, Math.floor(height / 2), width, 1);
    let changes = 0, last = "";
    for (let i = 0; i < data.length; i += 4) {
      const [red, , blue] = data.subarray(i, i + 3);
      const now = red > 2 * blue + 20 ? "red" : blue > 2 * red + 20 ? "blue" : last;
      if (now !== last && last !== "") ++changes;
      last = now;
    }
    return changes;
  });
}

/** Returns the mean brightness of the model's upper left and lower right quarter, from 0 to 255. */
async function quarters(viewer) {
  await viewer.frames();
  return viewer.page.locator("progressive-mesh").evaluate((element) => {
    const canvas = element.shadowRoot.querySelector("canvas"), { width, height } = canvas;
    const context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
    context.drawImage(canvas, 0, 0);
    return [0, 1].map((side) => {
      const { data } = context.getImageData((side * width) / 2, (side * height) / 2, width / 2, height / 2);
      let sum = 0, count = 0;
      for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] < 255) continue;
        sum += Math.max(data[i], data[i + 1], data[i + 2]);
        ++count;
      }
      return sum / count;
    });
  });
}

/**
 * Waits until the model is lit by the room. Polls, because no event reports it. Without the room, the side away from
 * the lamp is dark.
 */
async function inRoom(viewer) {
  for (;;) {
    const [left, right] = await quarters(viewer);
    if (left < 1.4 * right) return;
  }
}

/** Runs in the page: counts the pictures and the blocks of surfaces that arrive from the worker, in `window.arrived` and `window.blocks`. */
function countPictures() {
  window.arrived = window.blocks = 0;
  window.Worker = class extends Worker {
    constructor(...words) {
      super(...words);
      this.addEventListener("message", ({ data }) => {
        if (data.type === "picture") ++window.arrived;
        if (data.type === "block") ++window.blocks;
      });
    }
  };
}

/**
 * Performs `action` in the page, and records all frames up to the event `type`, and 30 later ones. Returns the mean
 * difference of each frame's pixels from those of the last frame, 0 to 255.
 */
function differences(viewer, type, action) {
  return viewer.page.locator("progressive-mesh").evaluate(async (element, [end, text]) => {
    const canvas = element.shadowRoot.querySelector("canvas"), [width, height] = [canvas.width / 2, canvas.height / 2].map(Math.floor);
    const context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d", { willReadFrequently: true });
    const frames = [];
    let left = Infinity;
    element.addEventListener(end, () => (left = 30), { once: true });
    new Function("element", text)(element);
    while (--left > 0) {
      await new Promise(requestAnimationFrame);
      context.clearRect(0, 0, width, height);
      context.drawImage(canvas, 0, 0, width, height);
      frames.push(context.getImageData(0, 0, width, height).data);
    }
    const last = frames.at(-1), distance = (frame) => frame.reduce((sum, value, i) => sum + Math.abs(value - last[i]), 0) / last.length;
    return frames.map(distance).filter((value, i, all) => value !== all[i - 1]);
  }, [type, action]);
}

/**
 * Checks that the frames approach the last one: no frame differs more from the last frame than its
 * predecessor does, except for noise.
 */
function assertSteady(seen) {
  assert.ok(seen.length > 1, "something changes");
  for (let i = 1; i < seen.length; ++i) assert.ok(seen[i] <= seen[i - 1] + 0.05, `frame ${i} goes back: ${seen}`);
}

describe("a textured model", () => {
  test("neither flashes nor swims when a finer picture and finer coordinates arrive", async () => {
    // The limits below hold for a model that fills about half of the view.
    const viewer = await open({ "max-texture": 0, "max-triangles": 0, "camera-orbit": "auto auto 140%" }, { attributes: {}, reducedMotion: "no-preference" });
    await viewer.events("load");
    await inRoom(viewer);
    const refined = await differences(viewer, "load", "element.removeAttribute('max-triangles'); element.setAttribute('pixel-error', 0)");
    assertSteady(refined);
    assert.ok(refined[0] < 4, `finer coordinates change ${refined[0]} of 255`);
    const sharpened = await differences(viewer, "picture", "element.removeAttribute('max-texture')");
    assertSteady(sharpened);
    assert.ok(sharpened[0] < 3, `a finer picture changes ${sharpened[0]} of 255`);
    await viewer.page.context().close();
  });

  test("tells its graphics memory, which 20 switches between models do not increase", async () => {
    const viewer = await open({}, { init: countWebGl });
    const measure = async (pictures) => {
      await viewer.events("picture", pictures);
      return viewer.page.evaluate(() => [window.pictureBytes(), window.seen.findLast(({ type }) => type === "memory").detail]);
    };
    const [first, told] = await measure(2);
    assert.equal(told.pictures, first);
    assert.ok(first > 4 * 512 ** 2);
    assert.ok(told.geometry > 0);
    for (let i = 1; i <= 20; ++i) {
      const name = i % 2 === 0 ? "ball" : "other";
      await viewer.page.locator("progressive-mesh").evaluate((element, src) => (element.src = src), `${host.url}/${name}.pmesh`);
      const [now] = await measure(2 * (i + 1));
      assert.equal(now, first, `after ${i} switches`);
    }
    assert.deepEqual(await viewer.complaints(), []);
    await viewer.page.context().close();
  });

  test("shows a picture that arrives while the WebGL context is lost, without fetching it again", async () => {
    const viewer = await open({ "max-texture": 0 }, { init: countPictures });
    await viewer.events("load");
    await viewer.events("picture");
    await viewer.page.evaluate(async () => {
      const canvas = document.querySelector("progressive-mesh").shadowRoot.querySelector("canvas");
      window.losing = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
    });
    // Withholds the response until the graphics context is lost.
    const asked = new Promise((resolve) => viewer.page.context().route("**/ball.pmesh", (route) => resolve(route)));
    await viewer.page.locator("progressive-mesh").evaluate((element) => element.removeAttribute("max-texture"));
    const route = await asked, requests = fetches();
    await viewer.page.evaluate(() => window.losing.loseContext());
    await route.continue();
    await viewer.page.waitForFunction(() => window.arrived === 2);
    await viewer.frames();
    assert.equal((await viewer.seen()).filter(({ type }) => type === "picture").length, 1, "no picture is shown without a context");
    await viewer.page.evaluate(() => window.losing.restoreContext());
    const [coarse, fine] = await viewer.events("picture", 2);
    assert.ok(fine.detail.side > coarse.detail.side);
    assert.equal(fetches(), requests + 1);
    // Polls, because the surface is uploaded to the new context in several steps.
    while (await stripes(viewer) < kStripes / 3);
    assert.deepEqual(viewer.errors.filter((error) => !error.includes("Context Lost")), []);
    await viewer.page.context().close();
  });

  test("is lit by a room after the first picture, by raking light, and can be cut open", async () => {
    const viewer = await open();
    await viewer.events("load");
    await viewer.events("picture", 2);
    await inRoom(viewer);
    await viewer.picture(join(pictures, "textured-room.png"));
    await viewer.sheet("light");
    await viewer.page.locator("label:has([value=raking])").click();
    const raking = await quarters(viewer);
    await viewer.picture(join(pictures, "textured-raking.png"));
    assert.ok(raking[0] > 2 * raking[1], `raking light comes from the upper left: ${raking}`);
    await viewer.page.locator("label:has([value=museum])").click();
    await viewer.sheet("section");
    await viewer.page.locator("input[name=section]").check();
    await viewer.picture(join(pictures, "textured-section.png"));
    assert.ok(await stripes(viewer) < kStripes / 3, "half of the stripes are cut away");
    assert.deepEqual(await viewer.complaints(), []);
    assert.ok(host.asked.includes("GET /progressive-mesh-room.js"));
    await viewer.page.context().close();
  });

  test("shows its picture, and the form alone if the visitor wants it", async () => {
    const viewer = await open();
    await viewer.events("load");
    await viewer.events("picture", 2);
    await viewer.picture(join(pictures, "textured.png"));
    const seen = await stripes(viewer);
    assert.ok(seen > kStripes / 3, `${seen} changes of colour`);
    const form = await viewer.toggle("form");
    await form.check();
    await viewer.picture(join(pictures, "textured-form.png"));
    assert.equal(await stripes(viewer), 0);
    await form.uncheck();
    assert.equal(await stripes(viewer), seen);
    assert.deepEqual(await viewer.complaints(), []);
    await viewer.page.context().close();
  });

  test("shows the picture of the head with the base mesh", async () => {
    const viewer = await open({ "max-texture": 0 });
    const [first] = await viewer.events("picture");
    await viewer.events("first-paint");
    const seen = await viewer.seen();
    const at = (type) => seen.findIndex((event) => event.type === type);
    assert.ok(at("picture") < at("refine"), "the picture is there when the first surface is shown");
    assert.equal(first.detail.bytes, 0);
    assert.ok(await stripes(viewer) > kStripes / 3);
    await viewer.page.context().close();
  });

  test("shows the picture with the base mesh, too, if both arrive before the code that draws them", async () => {
    const viewer = await open({ src: "", "max-texture": 0 }, { init: countPictures });
    const asked = new Promise((resolve) => viewer.page.context().route("**/progressive-mesh-stage.js", (route) => resolve(route)));
    await viewer.page.locator("progressive-mesh").evaluate((element, src) => element.setAttribute("src", src), `${host.url}/ball.pmesh`);
    const route = await asked;
    await viewer.page.waitForFunction(() => window.arrived === 1 && window.blocks > 0);
    await route.continue();
    await viewer.events("first-paint");
    const types = (await viewer.seen()).map(({ type }) => type);
    assert.ok(types.includes("picture") && types.indexOf("picture") < types.indexOf("refine"), types);
    await viewer.page.context().close();
  });

  test("fetches finer pictures up to max-texture", async () => {
    const viewer = await open({ "max-texture": 0 });
    await viewer.events("load");
    await viewer.frames();
    assert.equal((await viewer.seen()).filter(({ type }) => type === "picture").length, 1);
    await viewer.page.locator("progressive-mesh").evaluate((element) => element.removeAttribute("max-texture"));
    const [coarse, fine] = await viewer.events("picture", 2);
    assert.ok(fine.detail.side > coarse.detail.side);
    assert.ok(fine.detail.bytes > 0);
    assert.equal(fine.detail.texels, fine.detail.side ** 2, "the coarse picture is not kept");
    assert.deepEqual(await viewer.complaints(), []);
    await viewer.page.context().close();
  });

  test("shows its pictures again when a lost WebGL context comes back", async () => {
    const viewer = await open();
    await viewer.events("load");
    const shown = (await viewer.events("picture", 2)).length, before = await stripes(viewer);
    await viewer.loseContext();
    const again = (await viewer.events("picture", shown + 1)).at(-1);
    assert.ok(again.detail.texels > 0);
    // Polls, because the surface is uploaded to the new context in several steps.
    while (await stripes(viewer) !== before);
    assert.deepEqual(viewer.errors.filter((error) => !error.includes("Context Lost")), []);
    await viewer.page.context().close();
  });

  for (const transport of ["http", "ws"]) {
    test(`is shown by the daemon over ${transport}`, async () => {
      const page = await daemon.publish(ball, `Ball, ${transport}`);
      const viewer = await ViewerPage.open(browser, page, { attributes: { "pixel-error": "0", "max-texture": "0", transport } });
      await viewer.releaseLayers();
      await viewer.events("load");
      assert.ok(await stripes(viewer) > kStripes / 3);
      assert.deepEqual(await viewer.complaints(), []);
      await viewer.page.context().close();
    });
  }
});
