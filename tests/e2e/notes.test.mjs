// SPDX-License-Identifier: Apache-2.0
// Tests that a curator places notes on a model and makes a tour in the console, and that a visitor plays the tour by keyboard.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { mkdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { ViewerPage, launch } from "./browser.mjs";
import { Desk, overflow, tokenFor, violations } from "./console_desk.mjs";
import { Daemon } from "./daemon.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;

let browser, daemon, operator, id, plain, notes, tours;

before(async () => {
  await mkdir(pictures, { recursive: true });
  browser = await launch();
  daemon = await Daemon.start(bin);
  operator = await tokenFor(daemon, "operator");
  [id, plain] = await Promise.all(["Bust", "Plain bust"].map(async (title) => (await daemon.publish(scan, title, "--unit", "mm")).split("/").pop()));
  notes = fixedNotes();
  tours = [{ id: "around", titles: { en: "Around the bust" }, steps: [{ note: "face", seconds: 30 }, { note: "right", transition: "cut" }, { note: "left" }] }];
  await restore();
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
});

const api = (model = id) => `${daemon.url}/api/v1/models/${model}`;
const read = async (part) => (await (await fetch(`${api()}/${part}`)).json())[part];

async function put(part, list) {
  const headers = { Authorization: `Bearer ${operator}`, "Content-Type": "application/json" };
  const answer = await fetch(`${api()}/${part}`, { method: "PUT", headers, body: JSON.stringify({ [part]: list }) });
  assert.equal(answer.status, 200, await answer.text());
}

/** Returns three notes: in front, at the left and at the right of the model. */
function fixedNotes() {
  const note = (name, title, x, z, more = {}) =>
    ({ id: name, position: [x, 0.8, z], normal: [x, 0, z], texts: { en: { title } }, view: { direction: [x, 0, z], zoom: 1 }, light: "museum", section: "", ...more });
  const texts = {
    en: { title: "Face", text: "Of marble.\n\nSee [the catalogue](https://museum.example/bust).", alt: "The bust from the front" }, de: { title: "Gesicht" },
  };
  return [note("face", "Face", 0, 1, { texts, light: "raking,315", picture: `/api/v1/models/${id}/poster.png?width=240` }), note("left", "Left side", -1, 0), note("right", "Right side", 1, 0)];
}

/** Gives the model the notes and tours that each test expects. Tests that change them call this at their end. */
async function restore() {
  await put("tours", []);
  await put("notes", notes);
  await put("tours", tours);
}

/** Opens a page of the console with the editor of the notes. */
async function openEditor() {
  const desk = await Desk.open(browser, daemon, { token: operator, viewport: { width: 1440, height: 900 }, locale: "en-GB", acceptDownloads: true });
  await desk.go(`models/${id}`, "Bust");
  await showEditor(desk);
  return desk;
}

async function showEditor({ page }) {
  await page.waitForFunction(() => document.querySelector("progressive-mesh")?.presenter);
  await page.getByText("Notes and tours…").click();
  await page.getByRole("button", { name: "Place a note" }).waitFor();
}

const discard = ".notes-editor .actions:has([type=submit]) > :last-child"; // disabled if there are no unsaved changes
const saved = (page) => page.waitForFunction((selector) => document.querySelector(selector).disabled, discard);

/** Opens the page of a model with all detail. */
async function open({ model = id, attributes = {}, ...options } = {}) {
  const viewer = await ViewerPage.open(browser, `${daemon.url}/models/${model}`, { attributes: { "pixel-error": "0", lang: "en", ...attributes }, ...options });
  await viewer.releaseLayers();
  await viewer.events("load");
  await viewer.page.locator("button[name=save]").waitFor();
  return viewer;
}

const orbit = ({ page }) => page.locator("progressive-mesh").evaluate((element) => element.getCameraOrbit());
const focused = ({ page }) => page.evaluate(() => document.activeElement?.shadowRoot?.activeElement?.textContent ?? "");
const focusedName = ({ page }) => page.evaluate(() => document.activeElement?.shadowRoot?.activeElement?.getAttribute("aria-label") ?? "");
const stepText = ({ page }) => page.locator(".tour-panel [aria-live]");

/** Presses Tab until the element with this name has the focus. */
async function tabTo(viewer, name) {
  for (let i = 0; i < 60; ++i) {
    if ((await focusedName(viewer)) === name || (await focused(viewer)) === name) return;
    await viewer.page.keyboard.press("Tab");
  }
  assert.fail(`Tab does not reach "${name}"`);
}

test("a curator places notes on the surface, writes them, and orders them into a tour", { timeout: 240_000 }, async (context) => {
  context.after(restore);
  await put("tours", []);
  await put("notes", []);
  const desk = await Desk.open(browser, daemon, { token: operator, viewport: { width: 1440, height: 900 }, locale: "en-GB", acceptDownloads: true }), { page } = desk;
  await desk.go(`models/${id}`, "Bust");
  const viewer = page.locator("progressive-mesh"), canvas = viewer.locator("canvas");
  await page.waitForFunction(() => document.querySelector("progressive-mesh")?.presenter);
  const requested = () => page.evaluate(() => performance.getEntriesByType("resource").map(({ name }) => name.split("/").pop()));
  assert.ok(!(await requested()).some((name) => name === "console-notes.js" || name === "progressive-mesh-note-reader.js"), "the editor is loaded on first use");
  await page.getByText("Notes and tours…").click();
  await page.getByRole("button", { name: "Place a note" }).waitFor();
  const form = page.locator(".note-form"), field = (name) => form.locator(`[name=${name}]`);
  const clickMiddle = async () => {
    const { x, y, width, height } = await canvas.boundingBox();
    await page.mouse.click(x + width / 2, y + height / 2);
  };

  // Places the first note with the mouse. It has texts in two languages, a picture and raking light.
  await viewer.locator("button[name=light]").click();
  await viewer.locator("label:has([value=raking])").click();
  await desk.press("Place a note");
  await clickMiddle();
  await form.waitFor();
  assert.equal(await page.evaluate(() => document.activeElement.name), "title", "the title can be written at once");
  await field("title").fill("Face");
  await field("text").fill("Of marble.\n\nSee [the catalogue](https://museum.example/bust).");
  await field("picture").fill(`/api/v1/models/${id}/poster.png?width=240`);
  await field("alt").fill("The bust from the front");
  await field("language").selectOption("de");
  assert.equal(await field("title").inputValue(), "");
  await field("title").fill("Gesicht");
  await field("language").selectOption("en");
  assert.equal(await field("title").inputValue(), "Face", "each language has its own texts");
  await viewer.getByRole("button", { name: "Note 1: Face" }).waitFor();

  // Places two more notes from the left and from the right side, the last one with the keyboard only.
  await viewer.locator("label:has([value=museum])").click();
  for (const [key, presses, title] of [["ArrowRight", 8, "Left side"], ["ArrowLeft", 16, "Right side"]]) {
    for (let i = 0; i < presses; ++i) await canvas.press(key);
    if (title === "Left side") {
      await desk.press("Place a note");
      await clickMiddle();
    } else {
      await page.getByRole("button", { name: "Place it in the middle of the view" }).press("Enter");
    }
    await page.locator(".note-list .name").nth(title === "Left side" ? 1 : 2).waitFor();
    await field("title").fill(title);
  }
  await page.screenshot({ path: join(pictures, "notes-editor-1440.png") });

  await desk.press("New tour of all notes");
  await page.locator(".tour [name=en]").fill("Around the bust");
  await page.getByRole("button", { name: "Move stop 3 up" }).press("Enter");
  assert.deepEqual(await page.locator(".steps select:first-of-type").evaluateAll((all) => all.map((one) => one.selectedOptions[0].textContent)), ["Face", "Right side", "Left side"]);
  await page.getByLabel("Seconds of stop 1").fill("30");
  await page.getByLabel("Transition to stop 2").selectOption("cut");

  // Saves a note with an invalid picture URL. The form must show an error at this field, and keep all other input.
  await page.locator(".note-list .name", { hasText: "Face" }).click();
  await field("picture").fill("poster.png");
  await desk.press("Save notes and tours");
  await page.locator("[name=picture][aria-invalid]:focus ~ small", { hasText: "Expected: a URL" }).waitFor();
  await field("picture").fill(`/api/v1/models/${id}/poster.png?width=240`);
  assert.deepEqual(await read("notes"), []);
  for (const [width, height] of [[1440, 900], [390, 844]]) {
    await page.setViewportSize({ width, height });
    await page.locator(".noting").scrollIntoViewIfNeeded();
    await page.screenshot({ path: join(pictures, `notes-console-${width}.png`), fullPage: true });
    assert.ok((await overflow(page)) <= 0, `fits into ${width} pixels`);
  }
  assert.deepEqual(await violations(page), []);
  await page.setViewportSize({ width: 1440, height: 900 });
  await desk.press("Save notes and tours");
  await desk.says("Saved.");
  await saved(page);

  const notes = await read("notes"), [tour] = await read("tours");
  assert.deepEqual(notes.map(({ texts }) => texts.en.title), ["Face", "Left side", "Right side"]);
  assert.equal(notes[0].texts.de.title, "Gesicht");
  assert.deepEqual([notes[0].light.split(",")[0], notes[1].light], ["raking", "museum"]);
  assert.ok(notes[0].view.direction[0] !== notes[1].view.direction[0], "each note keeps its view");
  for (const { normal, view } of notes) assert.ok(normal.reduce((sum, part, axis) => sum + part * view.direction[axis], 0) > 0, "the normal points to the eye");
  assert.equal(tour.titles.en, "Around the bust");
  assert.deepEqual(tour.steps, [{ note: notes[0].id, seconds: 30 }, { note: notes[2].id, transition: "cut" }, { note: notes[1].id }]);

  // Saves the notes to a file. Reading IIIF annotations adds notes; reading the saved file restores the saved notes.
  const [download] = await Promise.all([page.waitForEvent("download"), desk.press("Save as a file")]);
  const file = await readFile(await download.path());
  assert.deepEqual(JSON.parse(file).notes, await read("notes"));
  const annotations = await (await fetch(`${daemon.url}/api/v1/iiif/4/${id}/annotations.json`)).text();
  const choose = (name, buffer) => page.locator(".notes-editor input[type=file]").setInputFiles({ name, mimeType: "application/json", buffer });
  await choose("annotations.json", Buffer.from(annotations));
  await page.getByText("3 notes were read.").waitFor();
  assert.equal(await page.locator(".note-list li").count(), 6);
  await desk.press("Save notes and tours");
  await saved(page);
  const six = await read("notes");
  for (const axis of [0, 1, 2]) assert.ok(Math.abs(six[4].position[axis] - six[1].position[axis]) < 1e-6 * Math.max(1, Math.abs(six[1].position[axis])), "points of the scene are those of the notes");
  await choose("saved.json", file);
  await page.getByText("3 notes were read.").waitFor();
  await page.waitForFunction(() => document.querySelectorAll(".note-list li").length === 3);
  await desk.press("Save notes and tours");
  await saved(page);
  assert.deepEqual(await read("notes"), JSON.parse(file).notes);
  await choose("other.json", Buffer.from("{}"));
  await page.getByText("This file has no notes").waitFor();
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("an operator sees that somebody else has changed the notes, and chooses which changes stay", { timeout: 120_000 }, async (context) => {
  context.after(restore);
  const desk = await openEditor(), { page } = desk, title = page.locator(".note-form [name=title]"), rows = page.locator(".note-list li");
  await page.locator(".note-list .name", { hasText: "Face" }).click();
  await title.fill("The face");
  await put("tours", []);
  await put("notes", notes.slice(0, 2));
  await desk.go("models", "Models");
  await desk.go(`models/${id}`, "Bust");
  await showEditor(desk);
  await page.locator(".notes-editor [role=status]", { hasText: "Somebody else has changed the notes meanwhile." }).waitFor();
  assert.equal(await rows.count(), 3, "the unsaved changes are kept");
  await desk.press("Discard changes");
  await page.locator(".note-list li:nth-child(2):last-child").waitFor();

  // The notes on the server change while the editor is open, so the first attempt to save is refused.
  await page.locator(".note-list .name", { hasText: "Face" }).click();
  await title.fill("The face");
  await put("notes", notes.slice(0, 1));
  await desk.press("Save notes and tours");
  await page.locator(".notes-editor [role=alert]", { hasText: "Saving replaces those changes; Discard shows them." }).waitFor();
  assert.deepEqual((await read("notes")).map(({ texts }) => texts.en.title), ["Face"]);
  await desk.press("Save notes and tours");
  await desk.says("Saved.");
  await saved(page);
  assert.deepEqual((await read("notes")).map(({ texts }) => texts.en.title), ["The face", "Left side"]);
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("text that is typed while a save is under way is kept", { timeout: 120_000 }, async (context) => {
  context.after(restore);
  const desk = await openEditor(), { page } = desk, title = page.locator(".note-form [name=title]");
  await page.locator(".note-list .name", { hasText: "Face" }).click();
  await title.fill("First");
  let isTyped, isSent;
  const typed = new Promise((resolve) => (isTyped = resolve)), sent = new Promise((resolve) => (isSent = resolve));
  await page.route("**/notes", async (route) => {
    isSent();
    if (route.request().method() === "PUT") await typed;
    await route.continue();
  });
  await desk.press("Save notes and tours");
  await sent;
  await title.fill("Second");
  isTyped();
  await desk.says("Saved.");
  assert.equal((await read("notes"))[0].texts.en.title, "First");
  assert.equal(await title.inputValue(), "Second");
  assert.ok(await page.locator(discard).isEnabled(), "the rest can be saved");
  await desk.press("Save notes and tours");
  await saved(page);
  assert.equal((await read("notes"))[0].texts.en.title, "Second");
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("the editor opens once, keeps the focus in its tour, and ends placing when it is closed", { timeout: 120_000 }, async (context) => {
  context.after(restore);
  await put("tours", [tours[0], { ...tours[0], id: "second", titles: { en: "Second", de: "Zweiter" } }]);
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk, summary = page.getByText("Notes and tours…");
  await desk.go(`models/${id}`, "Bust");
  await page.waitForFunction(() => document.querySelector("progressive-mesh")?.presenter);
  await summary.evaluate((element) => [1, 2, 3].forEach(() => element.click())); // clicks three times before the editor's script is loaded
  await page.getByRole("button", { name: "Place a note" }).waitFor();
  assert.equal(await page.locator(".notes-editor").count(), 1);

  const second = page.getByRole("group", { name: "Tour 2" });
  await second.getByRole("button", { name: "Move stop 3 up" }).press("Enter");
  const focus = () => page.evaluate(() => [document.activeElement.closest("[role=group]")?.ariaLabel, document.activeElement.ariaLabel]);
  assert.deepEqual(await focus(), ["Tour 2", "Move stop 3 up"]);
  await second.getByRole("button", { name: "Move stop 2 up" }).press("Enter");
  await second.getByRole("button", { name: "Remove stop 3" }).press("Enter");
  assert.equal((await focus())[0], "Tour 2", "the control is gone");
  await second.locator("[name=de]").fill("");
  await desk.press("Save notes and tours");
  await saved(page);
  assert.deepEqual((await read("tours"))[1], { id: "second", titles: { en: "Second" }, steps: [{ note: "left" }, { note: "face", seconds: 30 }] });

  // Saves an invalid sound file in the German texts of the first note. The editor must then show this note in German.
  const name = page.locator(".note-list .name"), field = (part) => page.locator(`.note-form [name=${part}]`);
  await name.nth(0).click();
  await field("language").selectOption("de");
  await field("audio").fill("sound.mp3");
  await field("language").selectOption("en");
  await name.nth(1).click();
  await desk.press("Save notes and tours");
  await page.locator("[name=audio][aria-invalid]:focus").waitFor();
  assert.deepEqual([await field("language").inputValue(), await field("title").inputValue()], ["de", "Gesicht"]);
  await desk.press("Discard changes");

  const place = page.getByRole("button", { name: "Place a note" });
  await place.click();
  assert.equal(await place.getAttribute("aria-pressed"), "true");
  await summary.click();
  await summary.click();
  assert.equal(await place.getAttribute("aria-pressed"), "false");
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("a visitor plays the tour by keyboard, and screen readers read each stop", { timeout: 120_000 }, async () => {
  const viewer = await open(), { page } = viewer, panel = page.locator(".tour-panel"), start = await orbit(viewer);
  await page.locator("canvas").focus();
  await tabTo(viewer, "Notes");
  await page.keyboard.press("Enter");
  await tabTo(viewer, "Play the tour: Around the bust");
  await page.keyboard.press("Enter");
  assert.equal(await focusedName(viewer), "Play", "with reduced motion, the tour waits for the visitor");
  assert.equal(await panel.getAttribute("aria-label"), "Around the bust");
  await panel.locator(".title").waitFor(); // the ARIA live region gets its text only after it is in the page
  assert.match(await stepText(viewer).textContent(), /^FaceOf marble\.See the catalogue\.$/);
  assert.equal(await stepText(viewer).getAttribute("aria-live"), "polite");
  assert.equal(await panel.locator(".place").textContent(), "1 of 3");
  assert.equal(await panel.locator("a").getAttribute("href"), "https://museum.example/bust");
  await page.waitForFunction(() => document.querySelector("progressive-mesh").shadowRoot.querySelector(".tour-panel img")?.naturalWidth === 240);
  assert.equal(await panel.locator("img").getAttribute("alt"), "The bust from the front");
  assert.ok(await page.locator("input[value=raking]").isChecked(), "the light of the note");
  await viewer.picture(join(pictures, "notes-tour.png"));

  await page.keyboard.press("ArrowRight");
  assert.equal(await stepText(viewer).textContent(), "Right side");
  const right = await orbit(viewer);
  assert.ok(Math.abs(right.theta - start.theta) > 0.3, "the view of the note");
  await page.keyboard.press("ArrowRight");
  assert.equal(await panel.locator(".place").textContent(), "3 of 3");
  await page.keyboard.press("ArrowRight");
  assert.equal(await stepText(viewer).textContent(), "Left side", "the tour has ended");
  await page.keyboard.press("ArrowLeft");
  assert.equal(await stepText(viewer).textContent(), "Right side");
  const again = await orbit(viewer);
  assert.ok(Math.abs(again.theta - right.theta) < 1e-3);
  await page.keyboard.press("Escape");
  assert.equal(await panel.count(), 0);
  assert.equal(await focused(viewer), "Play the tour: Around the bust", "the visitor continues at the same place");
  assert.ok(!(await page.locator("input[value=raking]").isChecked()), "the light is as before");
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});

test("a tour plays by itself to its end, and again from the start", { timeout: 120_000 }, async (context) => {
  context.after(restore);
  // The browser cannot play the sound of the first note.
  const [face, ...others] = notes;
  await put("notes", [{ ...face, texts: { en: { title: "Face", audio: "/broken.mp3" } } }, ...others]);
  await put("tours", [{ ...tours[0], steps: notes.map(({ id: note }) => ({ note, seconds: 1 })) }]);
  const viewer = await open({ reducedMotion: "no-preference", attributes: { "camera-controls": "" } }), { page } = viewer, panel = page.locator(".tour-panel");
  await page.route("**/broken.mp3", (route) => route.fulfill({ contentType: "audio/mpeg", body: "no sound" }));
  await viewer.sheet("notes");
  await page.getByRole("button", { name: "Play the tour" }).click();
  const shown = await viewer.events("tour-step", 3);
  assert.deepEqual(shown.map(({ detail }) => detail), [1, 2, 3].map((step) => ({ step, steps: 3 })));
  await panel.getByRole("button", { name: "Play" }).waitFor(); // this button appears when the tour has ended
  assert.equal((await viewer.events("tour-step")).length, 3);
  await page.keyboard.press("Space");
  assert.deepEqual((await viewer.events("tour-step", 4))[3].detail, { step: 1, steps: 3 });
  assert.equal(await focusedName(viewer), "Pause");
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});

test("a tour waits if the visitor looks around", { timeout: 120_000 }, async (context) => {
  context.after(restore);
  await put("tours", [{ ...tours[0], steps: notes.map(({ id: note }) => ({ note, seconds: 600 })) }]);
  const viewer = await open({ reducedMotion: "no-preference", attributes: { "camera-controls": "" } }), { page } = viewer, panel = page.locator(".tour-panel");
  await viewer.sheet("notes");
  await page.getByRole("button", { name: "Play the tour" }).click();
  await panel.getByRole("button", { name: "Pause" }).waitFor();
  for (const look of [["pointerdown", { pointerId: 1, isPrimary: true, bubbles: true }], ["wheel", { deltaY: 1, bubbles: true }], ["keydown", { key: "ArrowLeft", bubbles: true }]]) {
    await page.locator("canvas").dispatchEvent(...look);
    await panel.getByRole("button", { name: "Play" }).click();
    await panel.getByRole("button", { name: "Pause" }).waitFor();
  }
  await page.keyboard.press("Alt+ArrowRight");
  assert.equal(await panel.locator(".place").textContent(), "1 of 3");
  await panel.getByRole("button", { name: "End the tour" }).click();
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});

test("notes are in the visitor's language, come over WebSocket too, and are kept by links", { timeout: 120_000 }, async () => {
  const viewer = await open({ attributes: { lang: "de", transport: "ws" } }), { page } = viewer;
  await page.getByRole("button", { name: "Notiz 1: Gesicht" }).click();
  assert.equal(await page.locator(".notes [aria-current]").getAttribute("lang"), "de");
  await viewer.sheet("save");
  assert.match(await page.locator("input[name=link]").inputValue(), /note=1/);
  assert.deepEqual(await viewer.complaints(), []);
  await page.context().close();
});

test("a model without notes costs no request for them", { timeout: 120_000 }, async () => {
  const viewer = await open({ model: plain }), { page } = viewer;
  const names = await page.evaluate(() => performance.getEntriesByType("resource").map(({ name }) => name.split("/").pop()));
  assert.deepEqual(names.filter((name) => /note|tour/.test(name)), []);
  assert.ok(await page.locator("button[name=notes]").isHidden());
  await page.context().close();
});

test("notes look right on all screens", { timeout: 120_000 }, async () => {
  for (const [width, height] of [[1440, 900], [390, 844], [844, 390], [1920, 1080]]) {
    const viewer = await open({ width, height }), { page } = viewer;
    await viewer.sheet("notes");
    await page.locator(".notes").waitFor();
    await page.screenshot({ path: join(pictures, `notes-list-${width}.png`), animations: "disabled" });
    await page.getByRole("button", { name: "Play the tour" }).click();
    await page.locator(".tour-panel .title").waitFor();
    await page.screenshot({ path: join(pictures, `notes-tour-${width}.png`), animations: "disabled" });
    const box = await page.locator(".tour-panel").boundingBox(), view = await page.locator(".view").boundingBox();
    assert.ok(box.x >= view.x && box.x + box.width <= view.x + view.width && box.y >= view.y && box.y + box.height <= view.y + view.height + 1, `inside at ${width}`);
    await page.context().close();
  }
});
