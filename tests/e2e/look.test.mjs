// SPDX-License-Identifier: Apache-2.0
// Tests the choices of light, the contact shadow and the shading by curvature, on a static host.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { ViewerPage, launch } from "./browser.mjs";
import { writeStripedBall } from "./models.mjs";
import { StaticHost } from "./static_host.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const axe = await readFile(createRequire(new URL("../../web/package.json", import.meta.url)).resolve("axe-core/axe.min.js"), "utf8");

let browser, host, folder;

before(async () => {
  await mkdir(pictures, { recursive: true });
  browser = await launch();
  host = await StaticHost.start();
  folder = await mkdtemp(join(tmpdir(), "vitrine-look-"));
  const ball = join(folder, "ball.glb");
  await writeStripedBall(ball);
  for (const [name, mesh] of [["ball", ball], ["bust", scan]]) {
    const pmesh = join(folder, `${name}.pmesh`);
    await promisify(execFile)(join(bin, "vitrine"), ["build", mesh, "-o", pmesh]);
    host.add(`${name}.pmesh`, await readFile(pmesh));
  }
});

after(async () => {
  await browser?.close();
  host?.stop();
  await rm(folder, { recursive: true, force: true });
});

async function open(name, attributes = {}) {
  const viewer = await ViewerPage.open(browser, host.page({ src: `${host.url}/${name}.pmesh`, alt: name, lang: "en", "camera-controls": "", ...attributes }));
  await viewer.events("load");
  await viewer.page.locator("button[name=save]").waitFor();
  return viewer;
}

/**
 * Returns values of the canvas. `brightness` is the mean brightness of the opaque pixels (0 to
 * 255). `colour` is the largest difference between red and blue in an opaque pixel. `shaded` is the
 * number of dark, partly transparent pixels, which belong to the shadow or to edges.
 */
async function seen(viewer) {
  await viewer.frames();
  return viewer.page.locator("canvas").evaluate((canvas) => {
    const { width, height } = canvas, context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    let sum = 0, opaque = 0, colour = 0, shaded = 0;
    for (let i = 0; i < data.length; i += 4) {
      const red = data[i], blue = data[i + 2], alpha = data[i + 3];
      if (alpha > 5 && alpha < 250 && red < 30) ++shaded;
      if (alpha < 255) continue;
      ++opaque;
      sum += (red + data[i + 1] + blue) / 3;
      colour = Math.max(colour, Math.abs(red - blue));
    }
    return { brightness: sum / opaque, colour, shaded };
  });
}

/** Polls until `holds` resolves to true. Only the timeout of the whole test ends the polling. */
async function until(holds) {
  while (!(await holds()));
}

const asked = (part) => host.asked.some((line) => line.includes(part));

test("a contact shadow is loaded when the page or the visitor chooses it, follows a section, and goes away", async () => {
  const viewer = await open("bust", { "camera-orbit": "20deg 60deg 130%" }), { page } = viewer;
  const before = await seen(viewer);
  assert.ok(!asked("contact-shadow"), "its code is loaded on its first use");
  await page.locator("progressive-mesh").evaluate((element) => element.setAttribute("shadow-intensity", "0.8"));
  await until(async () => (await seen(viewer)).shaded > before.shaded + 2000);
  assert.ok(asked("contact-shadow"));
  await viewer.picture(join(pictures, "shadow.png"));
  const whole = (await seen(viewer)).shaded;
  await viewer.sheet("section");
  await page.locator("label:has([value=y])").click();
  await page.locator("input[name=section-flip]").check();
  assert.ok((await seen(viewer)).shaded < whole - 2000, "the part above the cut is far from the ground");
  await page.locator("input[name=section]").uncheck();
  assert.equal((await seen(viewer)).shaded, whole);
  await viewer.sheet("light");
  assert.ok(await page.locator("input[name=shadow]").isChecked());
  await page.locator("input[name=shadow]").uncheck();
  assert.equal((await seen(viewer)).shaded, before.shaded);
  await viewer.sheet("save");
  assert.match(await page.locator("input[name=link]").inputValue(), /shadow=off/);
  await page.locator("progressive-mesh").evaluate((element) => element.removeAttribute("shadow-intensity"));
  assert.equal((await seen(viewer)).shaded, before.shaded);
  await viewer.sheet("light");
  await page.locator("input[name=shadow]").check();
  assert.ok((await seen(viewer)).shaded >= whole);
  await viewer.sheet("measure");
  const { x, y, width, height } = await page.locator("canvas").boundingBox();
  const hint = page.locator(".sheet:not([hidden]) .hint");
  await page.mouse.click(x + width * 0.57, y + height * 0.76);
  assert.match(await hint.textContent(), /^Click a point/, "the shadow has no points to measure");
  await page.mouse.click(x + width / 2, y + height / 2);
  assert.match(await hint.textContent(), /next point/);
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});

test("the studio lights a model without textures by a room, and the museum as before", async () => {
  const viewer = await open("bust"), { page } = viewer;
  const first = await seen(viewer);
  await viewer.sheet("light");
  assert.ok(await page.locator("[value=relief]").isHidden(), "lamp and sky are the museum's light here");
  await page.locator("label:has([value=studio])").click();
  await until(async () => (await seen(viewer)).brightness > first.brightness + 15);
  await viewer.picture(join(pictures, "light-studio.png"));
  await page.locator("label:has([value=museum])").click();
  assert.deepEqual(await seen(viewer), first);
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});

test("a textured model shows its relief by lamp and sky", async () => {
  const viewer = await open("ball"), { page } = viewer;
  await viewer.sheet("light");
  await page.locator("label:has([value=relief])").click();
  const relief = await seen(viewer);
  await viewer.picture(join(pictures, "light-relief.png"));
  await page.locator("label:has([value=museum])").click();
  await until(async () => (await seen(viewer)).brightness !== relief.brightness);
  await page.context().close();
});

test("shading by curvature has no colour and no light, and goes with a section", async () => {
  const viewer = await open("ball", { "max-texture": "0" }), { page } = viewer;
  assert.ok((await seen(viewer)).colour > 150);
  await (await viewer.toggle("curvature")).check();
  const grey = await seen(viewer);
  assert.ok(grey.colour < 12, `${grey.colour}`);
  await viewer.picture(join(pictures, "curvature-ball.png"));
  await viewer.sheet("light");
  await page.locator("label:has([value=raking])").click();
  assert.deepEqual(await seen(viewer), grey);
  await viewer.sheet("section");
  await page.locator("input[name=section]").check();
  assert.ok((await seen(viewer)).colour > 40, "the inside has its own tone");
  await page.locator("input[name=section]").uncheck();
  assert.deepEqual(await seen(viewer), grey);
  await page.evaluate(axe);
  for (const tool of ["light", "surface"]) {
    await viewer.sheet(tool);
    assert.deepEqual(await page.evaluate(async () => (await window.axe.run("progressive-mesh")).violations.map(({ id }) => id)), [], tool);
  }
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
  const bust = await open("bust");
  await (await bust.toggle("curvature")).check();
  await bust.picture(join(pictures, "curvature.png"));
  await bust.page.context().close();
});
