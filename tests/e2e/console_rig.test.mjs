// SPDX-License-Identifier: Apache-2.0
// Tests an operator's whole work in the browser. The operator calibrates the simulated scanner,
// scans, watches the build, publishes the model, and sees it refined in the gallery.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch } from "./browser.mjs";
import { Desk, tokenFor } from "./console_desk.mjs";
import { DaemonAtRig } from "./rig.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const kSteps = 60;

let daemon, browser, desk, page, token;

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await DaemonAtRig.start(bin, ["--mesh", scan, "--height-mm", "80", "--steps", String(kSteps)]);
  browser = await launch();
  token = await tokenFor(daemon, "operator");
  desk = await Desk.open(browser, daemon, { token });
  ({ page } = desk);
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
});

const shoot = (name) => page.screenshot({ path: join(pictures, `console-rig-${name}.png`) });

test("shows what the camera sees, turns the table and lights the laser", async () => {
  await desk.go("scanners", "Scanners");
  await page.getByRole("link", { name: /^rig/ }).click();
  await desk.says("This scanner has no calibration yet");
  await desk.press("Laser on");
  await desk.says("The laser is on, for one minute at most.");
  await desk.press("+90°");
  await page.getByLabel("Live preview").check();
  await page.locator(".preview img:not(.pending)").waitFor();
  assert.equal(await page.locator(".preview img").evaluate((image) => image.naturalWidth), 1300);
  await shoot("preview");
  await page.getByLabel("Live preview").uncheck();
  await desk.press("Laser off");
  await desk.says("The laser is off.");
});

const banner = (text) => page.locator(".stopped:not([hidden])", { hasText: text }).waitFor();
const header = (text) => page.locator(".power li", { hasText: text }).waitFor();
/** Matches the header's text while a scan measures. */
const kMoves = /Table turns|Motor holds the table/;
const state = async () => (await (await page.request.get(`${daemon.url}/api/v1/scanners/rig`, { headers: { Authorization: `Bearer ${token}` } })).json());

test("says after a stop what laser and motor really do, and puts the laser out with its page", async () => {
  await desk.press("Emergency stop");
  await banner("Stopped: rig. Laser and motor are off.");
  await header("Laser off · Motor off");
  await desk.press("Laser on");
  await header("Laser on since");
  assert.equal((await state()).laser.state, "on");
  assert.equal(await page.locator(".stopped:not([hidden])").count(), 0);
  await shoot("lit-1280");
  await page.setViewportSize({ width: 390, height: 844 });
  await shoot("lit-390");
  await page.setViewportSize({ width: 1280, height: 860 });
  await desk.go("models", "Models");
  await header("Laser off · Motor off");
  assert.equal((await state()).laser.state, "off");
  await desk.go("scanners/rig", "rig");
  await desk.press("Laser on");
  await header("Laser on since");
  await page.goto(daemon.url);
  await expectDark();
});

/**
 * Waits until the laser is off. The page sends the command for this when the operator leaves the
 * page.
 */
async function expectDark() {
  while ((await state()).laser.state !== "off") await page.waitForTimeout(50);
}

test("says why a scan is not begun yet", async () => {
  await desk.go("scans/new", "New scan");
  await page.getByLabel("Title").fill("Too early");
  await desk.press("Start the scan");
  await page.getByRole("alert").getByText(/calibrat/i).waitFor();
});

test("calibrates", async () => {
  await desk.go("scanners/rig/calibrate", "Calibrate rig");
  await page.getByLabel("Poses").fill("12");
  await desk.press("Start");
  await page.getByRole("heading", { name: "Calibration no. 1" }).waitFor({ timeout: 120_000 });
  await page.waitForFunction(() => document.querySelector(".plot img")?.naturalWidth > 0);
  await shoot("calibrated");
  await page.getByRole("link", { name: "Accept" }).click();
});

test("scans, pauses, resumes, publishes, and a visitor sees it sharpen", async () => {
  await page.getByRole("link", { name: "New scan" }).click();
  await page.getByLabel("Title").fill("Demosthenes");
  await page.getByLabel("Steps per revolution").fill(String(kSteps));
  await desk.press("Start the scan");
  await page.getByRole("heading", { level: 1, name: "Demosthenes" }).waitFor();
  await desk.says(/[1-9]\d* points/);
  await desk.press("Pause");
  await desk.says("Paused");
  await shoot("paused");
  await desk.press("Resume");
  await header(kMoves);
  await desk.press("Emergency stop");
  await banner("Stopped: rig. Laser and motor are off.");
  await desk.says("stopped by the operator");
  await desk.press("Resume");
  await header(kMoves);
  assert.equal(await page.locator(".stopped:not([hidden])").count(), 0);
  await page.getByRole("button", { name: "Publish" }).waitFor({ timeout: 120_000 });
  await page.locator("progressive-mesh output .triangles").filter({ hasText: "triangles" }).waitFor();
  await shoot("draft");
  await desk.press("Publish");
  await page.locator(".badge.published").waitFor();
  await page.getByRole("link", { name: "See it in the gallery" }).click();
  await page.getByRole("heading", { level: 1, name: "Demosthenes" }).waitFor();
  await page.waitForFunction(() => {
    const [shown, all] = document.querySelector("progressive-mesh").shadowRoot.querySelector(".triangles").textContent.split(" of ");
    return shown !== "" && all === `${shown} triangles`;
  });
  await shoot("gallery");
  assert.deepEqual(desk.complaints, []);
});
