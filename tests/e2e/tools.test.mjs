// SPDX-License-Identifier: Apache-2.0
// Tests the viewer's tools by pointer, keyboard and screen reader texts, in a real browser with the
// real daemon. Each colour scheme has its own page. axe-core checks every state of the page.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { mkdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const axe = await readFile(createRequire(new URL("../../web/package.json", import.meta.url)).resolve("axe-core/axe.min.js"), "utf8");

let daemon, browser, url;

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  url = await daemon.publish(scan, "Demosthenes", "--unit", "mm");
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
});

/** Returns the violations that axe-core finds on the page. */
async function faults(viewer) {
  await viewer.frames();
  const { violations } = await viewer.page.evaluate(() => window.axe.run(document));
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target, failureSummary }) => `${target}: ${failureSummary}`).join("; ")}`);
}

/** Returns a hash of the canvas's picture, without the controls above it. */
async function drawn(viewer) {
  await viewer.frames();
  const picture = await viewer.page.locator("canvas").evaluate((canvas) => canvas.toDataURL());
  return createHash("sha256").update(picture).digest("hex");
}

/** Waits until the viewer announces a text that contains `words`. */
const heard = (viewer, words) => viewer.page.locator("[role=status]", { hasText: words }).waitFor({ state: "attached" });

/** Returns the fragment of the link to the current view. */
async function cameraOf(viewer) {
  await viewer.sheet("save");
  return viewer.page.locator("input[name=link]").inputValue().then((link) => new URL(link).hash);
}

/**
 * Makes the viewer reset itself, as in a kiosk whose visitor has left, and waits for the reset.
 * Before the call, the light must differ from the initial light.
 */
async function idle({ page }) {
  await page.locator("progressive-mesh").evaluate((element) => element.setAttribute("idle-reset", "0.1"));
  await page.locator("canvas").press("ArrowLeft");
  await page.locator("input[value=museum]:checked").waitFor({ state: "attached" });
  await page.locator(".sheet:not([hidden])").waitFor({ state: "detached" });
  await page.locator("progressive-mesh").evaluate((element) => element.removeAttribute("idle-reset"));
}

async function open(options, fragment = "") {
  const viewer = await ViewerPage.open(browser, url + fragment, options);
  await viewer.page.context().route("**/notes.json", (route) => route.fulfill({ json: [
    { position: [0, 0, 0], normal: [1, 0, 0], title: "Ear", text: "Restored." }, { position: [0, 0.4, 0], title: "Crown" },
  ] }));
  await viewer.page.evaluate(axe);
  return viewer;
}

describe("on a wide, light page", () => {
  let viewer, page;
  const button = (name) => page.locator(`button[name=${name}]`);
  const facts = (name) => button(name).locator("small").textContent();

  before(async () => {
    viewer = await open({ width: 1280, height: 800 });
    ({ page } = viewer);
    await viewer.events("first-paint");
  });
  after(() => viewer?.page.context().close());

  test("a hint to drag appears if nobody does anything, until the first touch", async () => {
    const hint = page.locator(".drag-hint", { hasText: "Drag to turn" });
    await hint.waitFor();
    await page.screenshot({ path: join(pictures, "tools-hint.png"), animations: "disabled" });
    await page.locator("canvas").click();
    await hint.waitFor({ state: "hidden" });
  });

  test("each choice tells its size, and its wait once the line has been measured", async () => {
    assert.match(await facts("lowest"), /^1\.\d KB at once$/);
    assert.match(await facts("highest"), /^\d+(\.\d)? KB$/);
    await heard(viewer, /^The coarse shape is shown, [1-9]/);
    await page.locator("progressive-mesh [role=status]").evaluate((place) => {
      window.said = [];
      new MutationObserver(() => place.textContent && window.said.push(place.textContent)).observe(place, { childList: true });
    });
    await viewer.releaseLayers();
    await viewer.events("load");
    await heard(viewer, "The requested detail is shown");
    const said = await page.evaluate(() => window.said), states = (await viewer.events("refine")).length;
    assert.ok(said.length <= 2 && states > said.length, `milestones alone, of ${states} states: ${said.join(" ")}`);
    assert.match(await page.locator("output .bytes").textContent(), /^[\d.]+ KB of [\d.]+ KB$/);
    assert.match(await facts("highest"), / KB at once$/);
    assert.equal(await facts("refine"), "complete");
    assert.match(await page.locator("output .error").textContent(), /^error ≤ [\d.]+ mm$/);
  });

  test("lowest, refine and highest are where they lead", async () => {
    const finest = await viewer.triangles();
    await viewer.settled(() => button("lowest").click());
    const coarsest = await viewer.triangles();
    await viewer.settled(() => button("refine").click());
    const refined = await viewer.triangles();
    assert.ok(coarsest < refined && refined < finest, `${coarsest} < ${refined} < ${finest}`);
    await viewer.settled(() => button("highest").click());
    assert.equal(await viewer.triangles(), finest);
    assert.equal(await button("highest").getAttribute("aria-pressed"), "true");
  });

  test("keys turn, zoom and reset, and the view is described in words", async () => {
    await page.locator("canvas").focus();
    const first = await cameraOf(viewer);
    await page.locator("canvas").focus();
    for (let i = 0; i < 8; ++i) await page.keyboard.press("ArrowRight");
    await heard(viewer, "Seen from the right.");
    const ring = await page.locator("canvas").evaluate((canvas) => getComputedStyle(canvas).outline);
    assert.match(ring, /solid 2px$/, "who uses keys sees where they go");
    await page.keyboard.press("+");
    assert.notEqual(await cameraOf(viewer), first);
    await page.locator("canvas").focus();
    await page.keyboard.press("Home");
    assert.equal(await cameraOf(viewer), first);
  });

  test("a link restores the view it was made of", async () => {
    const first = await cameraOf(viewer);
    await page.locator("canvas").focus();
    await page.keyboard.press("ArrowUp");
    const link = await cameraOf(viewer);
    await page.keyboard.press("Escape");
    await page.locator("canvas").focus();
    await page.keyboard.press("Home");
    assert.equal(await cameraOf(viewer), first);
    await page.evaluate((hash) => (location.hash = hash), link);
    await page.waitForFunction((hash) => document.querySelector("progressive-mesh").shadowRoot.querySelector("input[name=link]").value.endsWith(hash), link);
  });

  test("a link keeps light, section, surface and the detail that was chosen", async () => {
    await viewer.sheet("light");
    await page.locator("label:has([value=raking])").click();
    await viewer.sheet("section");
    await page.locator("label:has([value=y])").click();
    await page.locator("input[name=section-flip]").check();
    await page.locator("input[name=section-at]").press("ArrowRight");
    await viewer.sheet("surface");
    await page.locator("input[name=facets]").check();
    await viewer.settled(() => button("lowest").click());
    const link = await cameraOf(viewer);
    const { view, detail, ...others } = Object.fromEntries(new URLSearchParams(link.slice(1)));
    assert.ok(view && detail === String(await viewer.triangles()), link);
    assert.deepEqual(others, { light: "raking,315", section: "y,101,flip", surface: "facets" });
    const other = await open({ width: 1280, height: 800 }, link);
    await other.releaseLayers();
    await other.events("load");
    assert.equal(await cameraOf(other), link);
    assert.equal(await other.triangles(), await viewer.triangles());
    assert.ok(await other.page.locator("[value=raking]").isChecked());
    assert.ok(await other.page.locator("[name=facets]").isChecked());
    assert.equal(await drawn(other), await drawn(viewer));
    await other.page.context().close();
    await idle(viewer);
    assert.match(await cameraOf(viewer), /^#view=[^&]*$/);
  });

  test("a picture and the model at the level chosen can be taken along", async () => {
    await viewer.sheet("save");
    const [picture] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save a picture" }).click()]);
    assert.equal(picture.suggestedFilename(), "demosthenes.png");
    assert.equal((await readFile(await picture.path())).subarray(1, 4).toString(), "PNG");
    await page.locator("select[name=level]").selectOption("lowest");
    await page.locator("select[name=format]").selectOption("ply");
    const [model] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name: "Download the model" }).click()]);
    const coarsest = (await viewer.seen()).find(({ type }) => type === "refine").detail.triangles;
    assert.match((await readFile(await model.path())).toString("latin1"), new RegExp(`element face ${coarsest}\n`));
  });

  test("it fills the screen and gives it back", async () => {
    const { height } = await page.locator("progressive-mesh").boundingBox();
    const filled = () => page.evaluate(() => document.fullscreenElement?.localName);
    await button("fullScreen").click();
    await page.waitForFunction((before) => document.querySelector("progressive-mesh").clientHeight > before, height);
    assert.equal(await filled(), "progressive-mesh");
    await button("fullScreen").click();
    await page.waitForFunction(() => document.fullscreenElement === null);
  });

  test("raking light comes from where the visitor turns it", async () => {
    await viewer.sheet("light");
    const museum = await drawn(viewer);
    await page.locator("label:has([value=raking])").click();
    const left = await drawn(viewer);
    assert.notEqual(left, museum);
    await page.getByRole("slider", { name: "Direction of the raking light" }).press("PageUp");
    assert.equal(await page.getByRole("slider", { name: "Direction" }).getAttribute("aria-valuetext"), "0 degrees");
    assert.notEqual(await drawn(viewer), left);
    await page.screenshot({ path: join(pictures, "tools-raking.png"), animations: "disabled" });
    await page.locator("label:has([value=museum])").click();
    assert.equal(await drawn(viewer), museum);
  });

  test("a section cuts, moves and goes away", async () => {
    await viewer.sheet("section");
    const whole = await drawn(viewer);
    await page.locator("input[name=section]").check();
    const half = await drawn(viewer);
    assert.notEqual(half, whole);
    await page.locator("input[name=section-at]").press("PageUp");
    assert.notEqual(await drawn(viewer), half);
    await page.screenshot({ path: join(pictures, "tools-section.png"), animations: "disabled" });
    await page.locator("input[name=section]").uncheck();
    assert.equal(await drawn(viewer), whole);
  });

  test("two points of the surface are so far apart", async () => {
    await viewer.sheet("measure");
    const { x, y, width, height } = await page.locator("canvas").boundingBox();
    await page.mouse.click(x + width / 2, y + height * 0.3);
    await page.locator("canvas").press("Enter");
    await heard(viewer, "Distance");
    assert.match(await page.locator(".sheet .result:not(.size)").textContent(), /^[\d.]+ mm$/);
    assert.match(await page.locator(".sheet .size").textContent(), /^[\d.]+ × [\d.]+ × [\d.]+ mm$/);
    assert.match(await page.locator(".scale").textContent(), /^(0\.)?0*[125]0* mm$/);
    const { width: bar } = await page.locator(".scale").boundingBox();
    assert.ok(bar > 60 && bar <= 160, `${bar} pixels`);
    await page.screenshot({ path: join(pictures, "tools-measure.png"), animations: "disabled" });
  });

  test("notes of a file and hotspots of the page stand on the model", async () => {
    await page.locator("progressive-mesh").evaluate((element) => {
      element.innerHTML = '<b slot="hotspot-nose" data-position="0 0.2m 0.5m">Nose</b>';
      element.setAttribute("annotations", "/notes.json");
    });
    await page.getByRole("button", { name: "Note 1: Ear" }).click();
    await heard(viewer, "Seen from the right."); // announced when the camera has turned to the note
    assert.equal(await page.locator(".notes [aria-current]").textContent(), "EarRestored.");
    assert.ok(await page.locator("b[slot=hotspot-nose]").isVisible());
  });

  test("a tool's sheet closes with Escape, and its button has the focus", async () => {
    await viewer.sheet("light");
    await page.locator("input[value=museum]").press("Escape");
    assert.equal(await button("light").getAttribute("aria-expanded"), "false");
    assert.equal(await page.evaluate(() => document.activeElement.shadowRoot.activeElement.name), "light");
  });

  test("some time after the visitor has left all is as before", async () => {
    const home = await page.evaluate(() => (location.hash = "")).then(() => button("reset").click()).then(() => cameraOf(viewer));
    await viewer.sheet("light");
    await page.locator("label:has([value=studio])").click();
    await idle(viewer);
    assert.equal(await cameraOf(viewer), home.replace("&note=1", "")); // an earlier test has selected this note
  });

  test("axe finds no fault, whatever is open", async () => {
    for (const tool of ["light", "surface", "section", "measure", "notes", "save"]) {
      await viewer.sheet(tool);
      assert.deepEqual(await faults(viewer), [], tool);
    }
  });

  test("leaves no error in the console", async () => assert.deepEqual(await viewer.complaints(), []));
});

test("a narrow, dark page in German has all of it within reach of a finger", async () => {
  const viewer = await open({ width: 360, height: 640, colorScheme: "dark" });
  const { page } = viewer;
  await viewer.releaseLayers();
  await page.evaluate(() => {
    const other = document.createElement("progressive-mesh");
    for (const name of ["src", "alt"]) other.setAttribute(name, document.querySelector("progressive-mesh").getAttribute(name) ?? "");
    other.lang = "de";
    document.querySelector("progressive-mesh").replaceWith(other);
  });
  await viewer.sheet("light");
  await page.locator("label:has([value=raking])").click();
  assert.ok(await page.getByRole("radio", { name: "Streiflicht" }).isChecked());
  assert.deepEqual(await faults(viewer), []);
  await page.screenshot({ path: join(pictures, "tools-narrow-dark.png"), animations: "disabled" });
  const small = await page.locator("progressive-mesh").evaluate((element) =>
    [...element.shadowRoot.querySelectorAll("button, select, .choices label, .check")].filter((target) => target.checkVisibility())
      .map((target) => [target.getAttribute("name") ?? target.textContent, target.getBoundingClientRect()])
      .filter(([, { width, height }]) => width < 40 || height < 43.5).map(([name]) => name));
  assert.deepEqual(small, []);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0);
  assert.match(await viewer.counts(), /Dreiecken/);
  // Without its own `lang`, the viewer uses the language of the page.
  await page.locator("progressive-mesh").evaluate((element) => element.removeAttribute("lang"));
  await page.locator("button[name=light][title=Light]").waitFor();
  assert.match(await viewer.counts(), /triangles/);
  assert.ok(await page.locator("input[value=museum]").isChecked());
  await page.locator("html").evaluate((root) => (root.lang = "de"));
  await page.locator("button[name=light][title=Licht]").waitFor();
  assert.equal(await page.locator("button[name=light]").count(), 1);
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});
