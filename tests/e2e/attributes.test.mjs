// SPDX-License-Identifier: Apache-2.0
// Tests the attributes of <progressive-mesh>, both before the element starts and while it runs.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan } = process.env;
const kDegree = Math.PI / 180;

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

async function opened(attributes, options) {
  const viewer = await ViewerPage.open(browser, url, { attributes, ...options });
  viewer.holding = false;
  return viewer;
}

const element = (viewer) => viewer.page.locator("progressive-mesh");
const set = (viewer, name, value) =>
  element(viewer).evaluate((viewed, [key, text]) => (text === null ? viewed.removeAttribute(key) : viewed.setAttribute(key, text)), [name, value]);
const orbit = (viewer) => element(viewer).evaluate((viewed) => viewed.getCameraOrbit());

test("an error of one pixel is fetched where nothing else is asked for, more from near by, and never the whole from afar", async () => {
  const viewer = await opened({ "camera-orbit": "auto auto 300%" });
  await viewer.events("load");
  const far = await viewer.triangles();
  assert.ok(far < faces);
  await viewer.sharpened(far, () => set(viewer, "camera-orbit", "auto auto 60%"));
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
});

test("the amounts asked for may change at any time", async () => {
  const viewer = await opened({ "max-triangles": "4000" });
  await viewer.events("load");
  assert.ok(Math.abs(await viewer.triangles() - 4000) <= 400);
  await viewer.settled(() => set(viewer, "max-triangles", "9000"));
  assert.ok(Math.abs(await viewer.triangles() - 9000) <= 900);
  await viewer.settled(() => set(viewer, "max-triangles", "2000"));
  assert.ok(Math.abs(await viewer.triangles() - 2000) <= 200);
  const states = (await viewer.seen()).filter(({ type }) => type === "refine").map(({ detail }) => detail.triangles);
  const fine = states.findIndex((count) => count > 8000);
  assert.ok(states.slice(fine).every((count) => count > 1800), "nothing coarser than asked for is seen on the way down");
  await viewer.page.context().close();
});

test("max-bytes and target-error are kept to, and progress tells how much of it is there", async () => {
  const { levels } = await (await fetch(`${url.replace("/models/", "/api/v1/models/")}/manifest`)).json();
  const half = Math.round(levels.at(-1).cumulative_bytes / 2), fine = levels.at(-3).max_error;
  const viewer = await opened({ "max-bytes": String(half) });
  await viewer.events("load");
  const shown = async () => (await viewer.seen()).filter(({ type }) => type === "refine").at(-1).detail;
  const some = await shown();
  assert.equal(some.bytes, levels.findLast(({ cumulative_bytes: bytes }) => bytes <= half).cumulative_bytes);
  const told = (await viewer.events("progress")).map(({ detail }) => detail);
  assert.ok(told.length > 1 && told.every(({ bytes, total }) => bytes <= total));
  assert.deepEqual(told.at(-1), { bytes: some.bytes, total: some.bytes });
  // Changes both attributes in one call, because two calls would fire two `load` events.
  await viewer.settled(() => element(viewer).evaluate((viewed, error) => {
    viewed.setAttribute("target-error", error);
    viewed.removeAttribute("max-bytes");
  }, String(fine)));
  assert.equal((await shown()).triangles, levels.at(-3).faces);
  assert.equal((await shown()).vertices, levels.at(-3).vertices);
  await viewer.page.context().close();
});

test("the camera stands where its attributes say", async () => {
  const viewer = await opened({ "camera-orbit": "40deg 70deg auto", "field-of-view": "20deg", "max-triangles": "0" });
  await viewer.events("load");
  const { theta, phi, radius } = await orbit(viewer);
  assert.ok(Math.abs(theta - 40 * kDegree) < 1e-6 && Math.abs(phi - 70 * kDegree) < 1e-6);
  assert.equal(await element(viewer).evaluate((viewed) => viewed.getFieldOfView()), 20);
  await set(viewer, "camera-orbit", "-90deg 90deg 50%");
  const moved = await orbit(viewer);
  assert.ok(Math.abs(moved.theta + 90 * kDegree) < 1e-6 && Math.abs(moved.radius - radius / 2) < 1e-3 * radius);
  const { detail } = (await viewer.events("camera-change")).at(-1);
  assert.deepEqual(detail, { source: "none" });
  await set(viewer, "camera-target", "0.1m 0.2m 0.3m");
  const target = await element(viewer).evaluate((viewed) => viewed.getCameraTarget());
  target.forEach((value, axis) => assert.ok(Math.abs(value - [0.1, 0.2, 0.3][axis]) < 1e-6));
  await viewer.page.context().close();
});

test("only camera-controls lets the visitor move the camera", async () => {
  const viewer = await opened({ "max-triangles": "0" });
  await viewer.events("load");
  const drag = async () => {
    const { x, y, width, height } = await element(viewer).boundingBox();
    await viewer.page.mouse.move(x + width / 2, y + height / 3);
    await viewer.page.mouse.down();
    await viewer.page.mouse.move(x + width / 3, y + height / 3, { steps: 4 });
    await viewer.page.mouse.up();
    await viewer.frames();
    return (await orbit(viewer)).theta;
  };
  const touch = () => viewer.page.locator("progressive-mesh canvas").evaluate((canvas) => canvas.style.touchAction);
  assert.equal(await touch(), "none", "as the object's page says");
  await set(viewer, "touch-action", null);
  assert.equal(await touch(), "pan-y");
  const still = await drag();
  const turned = await drag();
  assert.notEqual(turned, still);
  assert.deepEqual((await viewer.seen()).findLast(({ type }) => type === "camera-change").detail, { source: "user-interaction" });
  await set(viewer, "camera-controls", null);
  assert.equal(await touch(), "auto");
  assert.equal(await drag(), turned);
  await set(viewer, "camera-controls", "");
  await set(viewer, "touch-action", "none");
  assert.equal(await touch(), "none");
  assert.notEqual(await drag(), turned);
  await viewer.page.context().close();
});

test("auto-rotate turns the camera, but not for those who want no motion", async () => {
  for (const reducedMotion of ["no-preference", "reduce"]) {
    const viewer = await opened({ "max-triangles": "0", "auto-rotate": "" }, { reducedMotion });
    await viewer.events("load");
    const { theta } = await orbit(viewer);
    if (reducedMotion === "reduce") {
      await viewer.frames();
      assert.equal((await orbit(viewer)).theta, theta);
    } else while ((await orbit(viewer)).theta === theta);
    await viewer.page.context().close();
  }
});

test("loading lazy waits until the viewer is near", async () => {
  const viewer = await opened({ loading: "lazy", "max-triangles": "0", style: "display:block; margin-top: 5000px; height: 400px" });
  await viewer.page.waitForLoadState("load");
  await viewer.frames();
  assert.equal((await viewer.seen()).length, 0);
  await element(viewer).scrollIntoViewIfNeeded();
  await viewer.events("load");
  await viewer.page.context().close();
});

test("the poster is seen until the first picture; reveal manual keeps it until it is dismissed", async () => {
  const poster = (viewer) => viewer.page.locator("progressive-mesh .poster");
  const address = `${url.replace("/models/", "/api/v1/models/")}/poster.png`;
  const waiting = await opened({ loading: "lazy", "max-triangles": "0", poster: address, style: "display: block; margin-top: 5000px; height: 400px" });
  await poster(waiting).waitFor();
  await waiting.settled(() => element(waiting).scrollIntoViewIfNeeded());
  assert.equal(await poster(waiting).isVisible(), false);
  await waiting.page.context().close();
  const viewer = await opened({ reveal: "manual", "max-triangles": "0", poster: address });
  await viewer.events("load");
  assert.ok(await poster(viewer).isVisible());
  await element(viewer).evaluate((viewed) => viewed.dismissPoster());
  assert.equal(await poster(viewer).isVisible(), false);
  await viewer.page.context().close();
});

test("alt is what is heard of the picture, now and later", async () => {
  const viewer = await opened({ "max-triangles": "0" });
  await viewer.events("load");
  await viewer.page.getByRole("img", { name: "Demosthenes", exact: true }).waitFor(); // the `alt` that the page sets
  await set(viewer, "alt", "Roman copy");
  await viewer.page.getByRole("img", { name: "Roman copy", exact: true }).waitFor();
  await set(viewer, "alt", null);
  await viewer.page.getByRole("img", { name: "Three-dimensional model" }).waitFor();
  await viewer.page.context().close();
});

test("what is removed is freed", async () => {
  const viewer = await opened({ "max-triangles": "0" });
  await viewer.events("load");
  assert.equal(viewer.page.workers().length, 1);
  const lost = await element(viewer).evaluate((viewed) => {
    const context = viewed.shadowRoot.querySelector("canvas").getContext("webgl2");
    viewed.remove();
    return context.isContextLost();
  });
  assert.ok(lost);
  while (viewer.page.workers().length > 0) await viewer.frames();
  await viewer.page.context().close();
});
