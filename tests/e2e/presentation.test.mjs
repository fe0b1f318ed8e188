// SPDX-License-Identifier: Apache-2.0
// Tests that the viewer shows a model as the daemon presents it: upright, in its unit, in the chosen view and light; and that an
// operator chooses all of this in the console.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { ViewerPage, launch } from "./browser.mjs";
import { Desk, overflow, tokenFor, violations } from "./console_desk.mjs";
import { Daemon } from "./daemon.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const kHalf = Math.SQRT1_2;

let browser, daemon, operator, id, plain;

before(async () => {
  await mkdir(pictures, { recursive: true });
  browser = await launch();
  daemon = await Daemon.start(bin);
  operator = await tokenFor(daemon, "operator");
  id = (await daemon.publish(scan, "Bust", "--unit", "mm")).split("/").pop();
  plain = (await model()).dimensions;
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
});

async function model() {
  return (await fetch(`${daemon.url}/api/v1/models/${id}`)).json();
}

async function present(presentation) {
  const answer = await fetch(`${daemon.url}/api/v1/models/${id}`, {
    method: "PATCH", headers: { Authorization: `Bearer ${operator}`, "Content-Type": "application/json" }, body: JSON.stringify({ presentation }),
  });
  assert.equal(answer.status, 200, await answer.clone().text());
  return answer.json();
}

/** Opens the model's page with all detail. */
async function open(attributes = {}, options = {}) {
  const viewer = await ViewerPage.open(browser, `${daemon.url}/models/${id}`, { attributes: { "pixel-error": "0", lang: "en", ...attributes }, ...options });
  await viewer.releaseLayers();
  await viewer.events("load");
  await viewer.page.locator("button[name=save]").waitFor();
  return viewer;
}

/** Returns width / height of the box around the drawn pixels of the canvas. */
function shape({ page }) {
  return page.locator("canvas").evaluate((canvas) => {
    const { width, height } = canvas, context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    let [left, right, top, bottom] = [width, 0, height, 0];
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        if (data[4 * (y * width + x) + 3] < 128) continue;
        [left, right, top, bottom] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y)];
      }
    }
    return (right - left) / (bottom - top);
  });
}

const near = (value, expected, part = 0.03) => assert.ok(Math.abs(value - expected) <= part * Math.abs(expected), `${value} instead of ${expected}`);
const size = ({ page }) => page.locator("progressive-mesh").evaluate((viewer) => viewer.presenter.size);
const numbers = (text) => [...text.replaceAll(",", "").matchAll(/[\d.]+/g)].map(Number);

test("a model is turned, scaled, and seen and lit as chosen, without another request before the first picture", async () => {
  const before = await open();
  const requests = (viewer) => viewer.page.evaluate(() => performance.getEntriesByType("resource").filter(({ name }) => name.includes("/api/v1/models/") && name.endsWith("/head")).length);
  assert.equal(await requests(before), 1);
  const upright = await shape(before);
  await before.page.context().close();

  // Lays the model on its back: its former top points to the back.
  await present({ rotation: [-kHalf, 0, 0, kHalf], scale: 2, view: { azimuth: 90, elevation: 0, zoom: 0.8 }, light: { preset: "raking", angle: 90 } });
  const viewer = await open({ "field-of-view": "5deg" }), { page } = viewer;
  assert.equal(await requests(viewer), 1);
  const orbit = await page.locator("progressive-mesh").evaluate((element) => element.getCameraOrbit());
  near(orbit.theta, Math.PI / 2);
  near(orbit.phi, Math.PI / 2);
  const [width, height, depth] = await size(viewer);
  near(width, 2 * plain.width);
  near(height, 2 * plain.depth);
  near(depth, 2 * plain.height);
  near(await shape(viewer), depth / height, 0.06);
  assert.ok(Math.abs((await shape(viewer)) - upright) > 0.2, "it lies");
  const { dimensions } = await model();
  near(height, dimensions.height);

  await viewer.sheet("measure");
  const [w, h, d] = numbers(await page.locator(".sheet .size").textContent());
  near(w, width), near(h, height), near(d, depth);
  assert.ok(await page.locator("[name=light][value=raking], [value=raking]").first().isChecked(), "the light is chosen");
  await viewer.picture(join(pictures, "presentation-lying.png"));

  await viewer.sheet("section");
  await page.locator("label:has([value=y])").first().click();
  await viewer.frames();
  assert.ok((await shape(viewer)) > (1.1 * depth) / height, "the upper half is cut away");
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});

test("over WebSocket, from a link, after a reset and in the error bound, too", async () => {
  await present({ rotation: [-kHalf, 0, 0, kHalf], scale: 1000, view: { azimuth: 90, elevation: 0 }, light: null });
  const viewer = await open({ transport: "ws", "target-error": "1e9" }), { page } = viewer;
  near((await size(viewer))[1], 1000 * plain.depth);
  const orbit = () => page.locator("progressive-mesh").evaluate((element) => element.getCameraOrbit().theta);
  await page.locator("canvas").press("ArrowRight");
  assert.ok(Math.abs((await orbit()) - Math.PI / 2) > 0.05);
  await page.locator("button[name=reset]").click();
  near(await orbit(), Math.PI / 2);
  assert.ok((await viewer.triangles()) < 2000, "an error of 1e9 needs the base mesh only");
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});

test("an operator turns, scales and presents a model in the console", async () => {
  await present(null);
  const desk = await Desk.open(browser, daemon, { token: operator, viewport: { width: 1440, height: 900 } }), { page } = desk;
  await desk.go(`models/${id}`, "Bust");
  const viewer = page.locator("progressive-mesh");
  await page.waitForFunction(() => document.querySelector("progressive-mesh")?.presenter);
  const requested = () => page.evaluate(() => performance.getEntriesByType("resource").some(({ name }) => name.endsWith("console-presentation.js")));
  assert.equal(await requested(), false, "the editor is loaded on first use");
  await page.getByText("Set the object right…").click();
  await page.getByRole("button", { name: "Turn by 90° about x" }).waitFor();
  const seen = () => viewer.evaluate((element) => element.presenter.size);
  const field = (name) => page.locator(`.presentation [name=${name}]`);

  // Turns the model with buttons, keys and the mouse. The daemon must not store this before the operator saves.
  await desk.press("Turn by 90° about x");
  near((await seen())[1], plain.depth);
  assert.deepEqual((await model()).presentation.rotation, [0, 0, 0, 1]);
  await desk.press("Turn by -90° about x");
  near((await seen())[1], plain.height);
  assert.ok(await page.getByRole("button", { name: "Save and show to visitors" }).isDisabled(), "all is as before");
  const handle = page.locator(".turner");
  await handle.focus();
  await page.keyboard.press("Shift+PageUp");
  const rolled = await seen();
  assert.ok(rolled[0] > plain.width * 1.01, "rolled by 15°");
  const box = await handle.boundingBox(), middle = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(...middle);
  await page.mouse.down();
  await page.mouse.move(middle[0] + 10, middle[1] + 12, { steps: 3 });
  await page.mouse.up();
  assert.notDeepEqual(await seen(), rolled);
  await page.screenshot({ path: join(pictures, "presentation-editor-1440.png") });
  await desk.press("Discard changes");
  near((await seen())[0], plain.width, 0.01);

  // Measures between two points and states twice the measured length as the true one, so the scale becomes 2.
  await desk.press("Check a known length");
  const stage = await page.locator(".stage-box").boundingBox();
  for (const part of [0.45, 0.6]) await page.mouse.click(stage.x + stage.width / 2, stage.y + stage.height * part);
  const [measured] = numbers(await page.getByText(/^Measured: /).textContent());
  assert.ok(measured > 0);
  await field("known").fill(String(2 * measured));
  await page.screenshot({ path: join(pictures, "presentation-ruler-1440.png") });
  await desk.press("Scale to this length");
  near(Number(await field("scale").inputValue()), 2, 0.01);
  near((await seen())[0], 2 * plain.width, 0.02);

  // Turns the camera, chooses raking light, and makes both the model's first view and light.
  await viewer.locator("canvas").press("ArrowRight");
  await viewer.locator("button[name=light]").click();
  await viewer.locator("label:has([value=raking])").click();
  await page.getByRole("group", { name: "First view", exact: true }).getByRole("button", { name: "Use the present view" }).click();
  await page.getByRole("group", { name: "Light", exact: true }).getByRole("button", { name: "Use the present light" }).click();
  await page.getByRole("group", { name: "Light", exact: true }).getByText("Raking light").waitFor();

  // Unsaved changes survive a visit to another page.
  await desk.go("models", "Models");
  await desk.go(`models/${id}`, "Bust");
  await page.getByText("Set the object right…").click();
  await page.getByText("These changes are not saved yet.").waitFor();
  near(Number(await field("scale").inputValue()), 2, 0.01);
  await page.waitForFunction((width) => Math.abs((document.querySelector("progressive-mesh")?.presenter?.size[0] ?? 0) / width - 2) < 0.02, plain.width);

  // Saves an invalid scale. The form must show an error at this field.
  await field("scale").fill("1e12");
  await desk.press("Save and show to visitors");
  await page.locator("[name=scale][aria-invalid]:focus ~ small", { hasText: "Expected: a number from" }).waitFor();
  await field("scale").fill("2");

  for (const [width, height] of [[1440, 900], [390, 844]]) {
    await page.setViewportSize({ width, height });
    await page.locator(".setting:not(.noting)").scrollIntoViewIfNeeded();
    await page.screenshot({ path: join(pictures, `presentation-console-${width}.png`), fullPage: width === 390 });
    await page.screenshot({ path: join(pictures, `presentation-console-${width}-view.png`) });
    assert.ok((await overflow(page)) <= 0, `fits into ${width} pixels`);
  }
  assert.deepEqual(await violations(page), []);
  await page.setViewportSize({ width: 1440, height: 900 });
  await desk.press("Save and show to visitors");
  await desk.says("Saved.");
  const { presentation, dimensions } = await model();
  assert.equal(presentation.scale, 2);
  assert.equal(presentation.light.preset, "raking");
  assert.ok(presentation.view.azimuth > 20, "the present view");
  near(dimensions.height, 2 * plain.height, 1e-3);
  await page.waitForFunction((width) => Math.abs((document.querySelector("progressive-mesh")?.presenter?.size[0] ?? 0) / width - 2) < 0.02, plain.width);
  assert.ok(await page.getByRole("button", { name: "Discard changes" }).isDisabled());
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});
