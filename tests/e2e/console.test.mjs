// SPDX-License-Identifier: Apache-2.0
// Tests an operator's typical tasks in the console, in a real browser with the real daemon: upload
// a file, publish the model, and delete it.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { mkdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, newContext } from "./browser.mjs";
import { Desk, overflow, tokenFor, violations } from "./console_desk.mjs";
import { Daemon } from "./daemon.mjs";
import { FakeScanner } from "./fake_scanner.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const kPiece = 8 << 20; // bytes per request of an upload
const kTetrahedron = Buffer.from("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");

// A PNG of two pixels, red and blue.
const kPicture = Buffer.from("iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR42mP4zwAE/wEHAAH/PX2MSQAAAABJRU5ErkJggg==", "base64");

let daemon, browser, operator, admin;

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  browser = await launch();
  operator = await tokenFor(daemon, "operator");
  admin = await tokenFor(daemon, "admin");
});

after(async () => {
  await browser?.close();
  await daemon?.stop();
});

/** Sends a request to the API with `token`, by default the operator's. */
async function asked(path, { token = operator, ...options } = {}) {
  return fetch(`${daemon.url}/api/v1${path}`, { ...options, headers: { Authorization: `Bearer ${token}`, "Content-Type": "application/json" } });
}

/**
 * Checks that a page of the gallery fits into narrow and wide windows and is accessible, in the light and the dark theme. Takes
 * screenshots.
 */
async function isFitInBothThemes(page, name) {
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    for (const [width, height] of [[360, 740], [768, 1024], [1920, 1080]]) {
      await page.setViewportSize({ width, height });
      await page.screenshot({ path: join(pictures, `gallery-${name}-${colorScheme}-${width}.png`) });
      assert.ok((await overflow(page)) <= 0, `${name} at ${width}`);
    }
    assert.deepEqual(await violations(page), [], `${name}, ${colorScheme}`);
  }
}

async function onDisplay() {
  return (await (await fetch(`${daemon.url}/api/v1/models`)).json()).models.map(({ title }) => title);
}

test("lets in who has a token, tells others why not, and forgets it in the end", async () => {
  const desk = await Desk.open(browser, daemon);
  await desk.isFit("sign-in");
  await desk.page.getByLabel("Access token").fill("vtr_nonsense");
  await desk.press("Sign in");
  await desk.says("The token is unknown or revoked; ask for a new one");
  await desk.signIn(operator);
  await desk.page.reload();
  await desk.says("There are no models yet");
  assert.equal(await desk.page.getByRole("link", { name: "Tokens" }).count(), 0, "for administrators alone");
  await desk.press("Sign out");
  await desk.page.getByLabel("Access token").waitFor();
  assert.equal(await desk.page.evaluate(() => sessionStorage.length + localStorage.length), 0);
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("a model that is dropped with its library and picture becomes one model with that picture", async () => {
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk;
  const obj = "mtllib w\u00fcrfel.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 2/1 3/2 4/3\nf 3/1 1/2 4/3\n";
  await desk.dropAll([["picture.png", kPicture], ["w\u00fcrfel.obj", Buffer.from(obj)], ["w\u00fcrfel.mtl", Buffer.from("newmtl a\nmap_Kd picture.png\n")]]);
  const card = page.locator("li.upload");
  await card.getByRole("heading", { name: "w\u00fcrfel.tar" }).waitFor();
  assert.equal(await card.getByLabel("Title").inputValue(), "w\u00fcrfel");
  await desk.press("Create the model", card);
  await card.getByText("Done", { exact: true }).waitFor({ timeout: 60_000 });
  const { models } = await (await asked("/models?drafts=true")).json();
  const { texture } = await (await asked(`/models/${models[0].id}/manifest`)).json();
  assert.deepEqual(models.map(({ title, faces }) => [title, faces]), [["w\u00fcrfel", 4]]);
  assert.ok(texture.pictures.length > 0, "the picture is found");
  await asked(`/models/${models[0].id}`, { method: "DELETE" });
  await desk.close();
});

test("a file that is dropped becomes a draft, is published, edited, replaced, withdrawn and deleted", async () => {
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk;
  await desk.drop("bust.obj", await readFile(scan));
  const card = page.locator("li.upload");
  await card.getByLabel("Title").fill("Bust of Demosthenes");
  await card.getByLabel("Creator").fill("Polyeuktos");
  await card.getByLabel("Unit").selectOption("mm");
  await desk.press("Create the model", card);
  await card.getByText("Done", { exact: true }).waitFor({ timeout: 60_000 });
  assert.deepEqual(await onDisplay(), [], "a draft is nobody's business");
  await card.getByRole("link", { name: "Open the model" }).click();
  await page.getByRole("heading", { level: 1, name: "Bust of Demosthenes" }).waitFor();
  // The draft is visible in the viewer, because the viewer sends the operator's token.
  await page.locator("progressive-mesh output .triangles").filter({ hasText: "triangles" }).waitFor();
  await page.locator("svg.curve circle").first().waitFor();
  await desk.isFit("draft");

  await desk.press("Publish");
  // Waits for the button that appears when the page has been redrawn.
  await page.getByRole("button", { name: "Withdraw from the gallery" }).waitFor();
  assert.deepEqual(await onDisplay(), ["Bust of Demosthenes"]);
  await page.getByLabel("Title").fill("Demosthenes");
  await page.getByLabel("Licence").fill("CC-BY-4.0");
  await page.getByLabel("Accuracy of the scan").fill("0.05");
  await page.getByLabel("Description").fill("A copy.\n\nOf marble.");
  await desk.press("Save");
  await page.getByRole("heading", { level: 1, name: "Demosthenes", exact: true }).waitFor();
  const id = page.url().split("/").pop(), now = await (await asked(`/models/${id}`)).json();
  assert.deepEqual([now.title, now.creator, now.licence, now.unit, now.accuracy], ["Demosthenes", "Polyeuktos", "CC-BY-4.0", "mm", 0.05]);

  assert.equal(now.description, "A copy.\n\nOf marble.");
  await page.getByLabel("Subject").fill("x".repeat(5000));
  await desk.press("Save");
  await page.locator("[name=subject][aria-invalid]:focus ~ small", { hasText: "Expected: one line of text of at most 4096 bytes" }).waitFor();
  await page.getByLabel("Subject").fill("");

  await asked(`/models/${id}`, { method: "PATCH", body: JSON.stringify({ title: "By a colleague" }) });
  await page.getByLabel("Title").fill("Too late");
  await desk.press("Save");
  await desk.says("Somebody else has changed this model meanwhile: Title.");
  await desk.press("Discard unsaved texts");
  assert.equal(await page.getByLabel("Title").inputValue(), "By a colleague");

  await page.reload();
  await page.getByText("Replace the file…").click();
  await desk.drop("small.obj", kTetrahedron);
  await desk.press("Replace");
  await page.locator("dd").filter({ hasText: "4 triangles" }).waitFor({ timeout: 60_000 });
  assert.equal((await (await asked(`/models/${id}`)).json()).faces, 4);

  await page.reload();
  await desk.press("Withdraw from the gallery");
  await page.locator(".badge.draft").waitFor();
  assert.deepEqual(await onDisplay(), []);
  await desk.press("Delete…");
  await page.getByRole("dialog").getByText("Delete “By a colleague”?").waitFor();
  assert.deepEqual(await violations(page), [], "the question");
  await desk.press("Keep");
  await desk.press("Delete…");
  await desk.press("Delete", page.getByRole("dialog"));
  await desk.says("There are no models yet");
  assert.equal((await asked(`/models/${id}`)).status, 404);
  await desk.go("jobs", "Jobs");
  await page.locator("li.job").nth(1).waitFor();
  await desk.isFit("jobs");
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("what the build of a file changed is seen after the upload, and on the model's page", async () => {
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk;
  await desk.drop("twice.obj", Buffer.concat([kTetrahedron, Buffer.from("f 3 1 4\n")]));
  const card = page.locator("li.upload");
  await desk.press("Create the model", card);
  await card.getByText("1 duplicate face dropped").waitFor({ timeout: 60_000 });
  await card.getByText("Done", { exact: true }).waitFor({ timeout: 60_000 });
  await card.locator("summary").click();
  assert.equal(await card.getByText("1 duplicate face dropped").isVisible(), false, "the list can be closed");
  await card.getByRole("link", { name: "Open the model" }).click();
  await page.getByRole("heading", { name: "What the build changed or left out" }).waitFor();
  await page.getByText("1 duplicate face dropped").waitFor();
  await desk.isFit("repairs");
  const id = page.url().split("/").pop();

  await page.getByText("Replace the file…").click();
  await desk.drop("small.obj", kTetrahedron);
  await desk.press("Replace");
  await page.getByRole("heading", { name: "What the build changed or left out" }).waitFor({ state: "hidden", timeout: 60_000 });
  assert.deepEqual((await (await asked(`/models/${id}`)).json()).repairs, []);
  await asked(`/models/${id}`, { method: "DELETE" });
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("an upload resumes where it was after the page was closed", async () => {
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk;
  const large = { name: "large.ply", bytes: Buffer.alloc(kPiece + 1000) }, offsets = [];
  let hold = true, secondIsHeld;
  const held = new Promise((resolve) => (secondIsHeld = resolve));
  await page.context().route("**/api/v1/uploads/*", (route) => {
    if (route.request().method() !== "PATCH") return route.continue();
    const offset = Number(route.request().headers()["upload-offset"]);
    offsets.push(offset);
    // While `hold` is true, holds back all pieces of the upload except the first.
    return hold && offset > 0 ? secondIsHeld() : route.continue();
  });
  page.on("dialog", (dialog) => dialog.accept());
  await desk.drop(large.name, large.bytes);
  await held;
  await page.reload();
  await desk.says("Choose the same file again");
  await page.screenshot({ path: join(pictures, "console-interrupted.png") });
  hold = false;
  await desk.drop(large.name, large.bytes);
  await desk.says("Uploaded");
  assert.deepEqual(offsets, [0, kPiece, kPiece]);
  assert.equal(await page.locator("li.upload, li.interrupted").count(), 1);
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("who places the target is waited for, and sees what has come of it", async () => {
  const scanner = new FakeScanner(3), desk = await Desk.open(browser, daemon, { token: operator, play: (context) => scanner.play(context) }), { page } = desk;
  await desk.go("scanners", "Scanners");
  await desk.isFit("scanners");
  await desk.go("scanners/rig", "rig");
  await desk.isFit("scanner");
  await page.getByRole("link", { name: "Calibrate" }).click();
  await page.getByLabel("Poses").fill("3");
  await desk.press("Start");
  for (const pose of [1, 2, 3]) {
    await desk.says(`Place the target: pose ${pose} of 3`);
    if (pose === 2) await desk.isFit("wizard");
    await desk.press("The target is placed");
  }
  await page.getByRole("heading", { name: "Calibration no. 1" }).waitFor();
  await desk.says("0.02 mm");
  await desk.isFit("calibrated");
  await page.getByRole("link", { name: "Accept" }).click();
  await page.getByRole("heading", { level: 1, name: "rig" }).waitFor();
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("the emergency stop is in sight on every page, and says whether it was obeyed", async () => {
  const scanner = new FakeScanner(3), desk = await Desk.open(browser, daemon, { token: operator, play: (context) => scanner.play(context), viewport: { width: 360, height: 640 } });
  for (const [section, heading] of [["models", "Models"], ["scanners", "Scanners"], ["scans", "Scans"], ["scans/new", "New scan"], ["jobs", "Jobs"]]) {
    await desk.go(section, heading);
    const box = await desk.page.getByRole("button", { name: "Emergency stop" }).boundingBox();
    assert.ok(box.y >= 0 && box.y + box.height <= 640 && box.height >= 44, section);
  }
  await desk.press("Emergency stop");
  await desk.says("Stopped: rig. Laser and motor are off.");
  assert.equal(scanner.stops, 1);
  scanner.stopStatus = 409;
  await desk.press("Emergency stop");
  await desk.says("Switch the scanner off at its power supply. The board is gone; plug it in");
  assert.deepEqual(await violations(desk.page), []);
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("administrators make and revoke tokens; a wrong one is reported at its field", async () => {
  const desk = await Desk.open(browser, daemon, { token: admin }), { page } = desk;
  await page.getByRole("link", { name: "Tokens" }).click();
  await page.getByLabel("Name").fill("x".repeat(2000));
  await desk.press("Create a token");
  await page.locator("[aria-invalid][name=label]").waitFor();
  assert.match(await page.locator("[aria-invalid] ~ small").textContent(), /^Expected: /);
  await page.getByLabel("Name").fill("Kiosk");
  await page.getByLabel("Role").selectOption("viewer");
  await desk.press("Create a token");
  const token = await page.getByLabel("Token", { exact: true }).inputValue();
  assert.equal((await asked("/jobs", { token })).status, 200);
  await desk.isFit("tokens");
  await desk.press("Revoke", page.locator("li.card", { hasText: "Kiosk" }));
  await desk.press("Revoke", page.getByRole("dialog"));
  await desk.says("The token is revoked.");
  assert.equal((await asked("/jobs", { token })).status, 401);
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("speaks German, and is as fit in the dark", async () => {
  const scanner = new FakeScanner(3);
  const context = await newContext(browser, { locale: "de-DE", colorScheme: "dark", reducedMotion: "reduce" });
  await scanner.play(context);
  const desk = new Desk(await context.newPage(), daemon), { page } = desk;
  await page.goto(`${daemon.url}/console`);
  await page.getByLabel("Zugangs-Token").fill(admin);
  await page.getByRole("button", { name: "Anmelden" }).click();
  for (const [section, heading] of [["models", "Modelle"], ["scanners", "Scanner"], ["scanners/rig", "rig"], ["scans", "Aufnahmen"], ["scans/new", "Neue Aufnahme"], ["tokens", "Tokens"]]) {
    await desk.go(section, heading);
    await desk.isFit(`dark-${section.replaceAll("/", "-")}`);
  }
  assert.equal(await page.evaluate(() => document.documentElement.lang), "de");
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("the gallery is searched, and an object's page tells what is known and gives it away", async () => {
  for (const title of ["Athena", "Hermes"]) await daemon.publish(scan, title);
  const { models: [{ id }] } = await (await fetch(`${daemon.url}/api/v1/models?q=Hermes`)).json();
  const words = { creator: "Praxiteles", licence: "CC0-1.0", unit: "mm", accuracy: 0.05, description: "Holds the infant Dionysos.", date: "about 340 BC" };
  await asked(`/models/${id}`, { method: "PATCH", body: JSON.stringify(words) });
  const context = await newContext(browser, { viewport: { width: 1280, height: 860 }, permissions: ["clipboard-read", "clipboard-write"] }), page = await context.newPage();
  await page.goto(daemon.url);
  await page.locator("#models li").nth(1).waitFor();
  await page.waitForFunction(() => [...document.images].every(({ naturalWidth }) => naturalWidth > 0));
  await isFitInBothThemes(page, "all");
  await page.getByRole("searchbox").fill("herm");
  await page.getByText("Found: 1").waitFor();
  await page.getByRole("searchbox").fill("nothing like it");
  await page.getByText("Nothing on display matches").waitFor();
  await page.goto(`${daemon.url}/?q=praxiteles`);
  await page.getByRole("link", { name: "Hermes" }).click();
  await page.getByText("Holds the infant Dionysos.").waitFor();
  assert.equal(await page.getByRole("link", { name: "CC0-1.0" }).getAttribute("href"), "https://creativecommons.org/publicdomain/zero/1.0/");
  await page.getByText("± 0.05 mm").waitFor();
  assert.equal(await page.locator("dd:has-text('CC0-1.0') svg[aria-hidden=true] path").count(), 2, "the symbols of CC and of zero");
  const about = page.locator("#about");
  await about.locator(".copyable").first().getByRole("button", { name: "Copy" }).click();
  await about.getByText("Copied").waitFor();
  assert.match(await page.evaluate(() => navigator.clipboard.readText()), new RegExp(`<progressive-mesh src="${daemon.url}/api/v1/models/${id}" alt="Hermes" camera-controls `));
  assert.equal((await page.request.get(await about.getByRole("link", { name: "IIIF manifest" }).evaluate((link) => link.href))).status(), 200);
  await about.getByLabel("Format").selectOption("stl");
  await about.getByLabel("Level of detail").selectOption("lowest");
  const download = page.waitForEvent("download");
  await about.getByRole("link", { name: "Download" }).click();
  assert.ok((await readFile(await (await download).path())).length > 84);
  await isFitInBothThemes(page, "object");
  await context.close();
});

test("what a registrar enters stands on the object's page and narrows the gallery", async () => {
  const [kouros, kore] = [await daemon.publish(scan, "Kouros"), await daemon.publish(scan, "Kore")].map((url) => url.split("/").pop());
  await asked(`/models/${kouros}`, { method: "PATCH", body: JSON.stringify({ material: "marble", period: "Archaic" }) });
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk;
  const fill = (label, text) => page.getByLabel(label, { exact: true }).fill(text);
  await desk.go(`models/${kore}`, "Kore");
  await page.getByLabel("Rights statement").selectOption({ label: "No Known Copyright" });
  await page.getByLabel("Unit").selectOption("mm");
  for (const [label, text] of [["Material", "marble; pigment"], ["Period", "Archaic"], ["Collection", "Akropolis"], ["Provenance", "Found in 1886.\n\nNorth-west of the Erechtheion."], ["Scanner", "Rig 2"],
    ["Contributors", "Kavvadias"], ["Language", "grc"], ["Type", "Sculpture"], ["Related", "Kore 670"], ["Place and period", "Attica, 520 BC"]])
    await fill(label, text);
  await fill("DOI", "https://doi.org/10.5281/zenodo.1");
  await desk.press("Save");
  await page.locator("[name=doi][aria-invalid]:focus ~ small", { hasText: "Expected: a DOI without a resolver" }).waitFor();
  await fill("DOI", "10.5281/zenodo.1");
  await desk.press("Save");
  await desk.says("Saved.");
  await desk.isFit("registrar");
  const record = await (await asked(`/models/${kore}`)).json();
  assert.deepEqual(["contributor", "language", "type", "relation", "coverage"].map((name) => record[name]), ["Kavvadias", "grc", "Sculpture", "Kore 670", "Attica, 520 BC"]);
  assert.deepEqual([record.material, record.provenance, record.rights_statement, record.dimensions.unit],
    ["marble; pigment", "Found in 1886.\n\nNorth-west of the Erechtheion.", "http://rightsstatements.org/vocab/NKC/1.0/", "mm"]);

  const shown = page.locator("#models h2"), facet = (name) => page.locator("#groups").getByRole("button", { name, exact: true });
  const isShown = (count) => page.waitForFunction((wanted) => document.querySelectorAll("#models li").length === wanted, count);
  await page.goto(`${daemon.url}/?period=Archaic`);
  await isShown(2);
  assert.ok(await facet("Archaic 2").isVisible(), "the facets are open if one is chosen");
  await page.getByLabel("Order").selectOption("title");
  await page.waitForFunction(() => document.querySelector("#models h2")?.textContent === "Kore");
  await facet("pigment 1").click();
  await isShown(1);
  await page.getByText("Found: 1").waitFor();
  assert.deepEqual(Object.fromEntries(new URL(page.url()).searchParams), { period: "Archaic", material: "pigment", sort: "title" });
  assert.equal(await facet("pigment 1").evaluate((button) => button === document.activeElement), true, "the focus stays");
  await isFitInBothThemes(page, "facets");
  await page.reload();
  await isShown(1);
  assert.equal(await facet("pigment 1").getAttribute("aria-pressed"), "true");
  await facet("pigment 1").click();
  await isShown(2);
  assert.deepEqual(await shown.allTextContents(), ["Kore", "Kouros"]);
  await page.getByRole("link", { name: "Kore" }).click();
  await page.getByRole("link", { name: "No Known Copyright" }).waitFor();
  const symbol = await page.locator("dd:has-text('No Known Copyright') svg[aria-hidden=true]").boundingBox();
  assert.ok(symbol.width >= 14 && Math.abs(symbol.width - symbol.height) < 1, "the symbol of the statement");
  await page.getByText("mm (W × H × D)").waitFor();
  assert.equal(await page.getByRole("link", { name: "10.5281/zenodo.1" }).getAttribute("href"), "https://doi.org/10.5281/zenodo.1");
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("unsaved texts are not lost, and those of two operators are both kept", async () => {
  const id = (await daemon.publish(scan, "Nike")).split("/").pop(), record = async () => (await asked(`/models/${id}`)).json();
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk, save = page.getByRole("button", { name: "Save", exact: true });
  const field = (label) => page.getByLabel(label, { exact: true });
  const sent = [];
  page.on("request", (request) => request.method() === "PATCH" && sent.push(request.postDataJSON()));
  await desk.go(`models/${id}`, "Nike");
  assert.ok(await save.isDisabled(), "nothing is unsaved");

  // While the form is built again.
  await field("Provenance").fill("Found in 1863.\n\nSamothrace.");
  await field("Material").fill("marble");
  await desk.press("Withdraw from the gallery");
  await page.locator(".badge.draft").waitFor();
  assert.equal(await field("Provenance").inputValue(), "Found in 1863.\n\nSamothrace.");
  await desk.press("Publish");
  await page.locator(".badge.published").waitFor();
  assert.equal(await field("Material").inputValue(), "marble");
  await page.getByText("Replace the file…").click();
  await desk.drop("small.obj", kTetrahedron);
  await desk.press("Replace");
  await page.locator("dd").filter({ hasText: "4 triangles" }).waitFor({ timeout: 60_000 });
  assert.equal(await field("Material").inputValue(), "marble");

  // On another page, and when the browser leaves the console.
  await desk.go("jobs", "Jobs");
  await desk.go(`models/${id}`, "Nike");
  await desk.says("These changes are not saved yet.");
  assert.equal(await field("Provenance").inputValue(), "Found in 1863.\n\nSamothrace.");
  await desk.isFit("unsaved");
  const question = page.waitForEvent("dialog");
  const left = page.evaluate(() => void setTimeout(() => location.reload()));
  const dialog = await question;
  assert.equal(dialog.type(), "beforeunload");
  await dialog.dismiss();
  await left;
  assert.equal(await field("Material").inputValue(), "marble");

  // A colleague changes another field and the same field.
  await asked(`/models/${id}`, { method: "PATCH", body: JSON.stringify({ creator: "Pythokritos", material: "Parian marble" }) });
  await save.click();
  await desk.says("Somebody else has changed this model meanwhile: Creator, Material.");
  await desk.says("Stored meanwhile: “Parian marble”");
  assert.equal(await field("Creator").inputValue(), "Pythokritos");
  assert.equal(await field("Material").inputValue(), "marble");
  assert.equal((await record()).material, "Parian marble", "nothing is replaced before the operator has seen it");
  await desk.isFit("outdated");
  await save.click();
  await desk.says("Saved.");
  const { creator, material, provenance } = await record();
  assert.deepEqual([creator, material, provenance], ["Pythokritos", "marble", "Found in 1863.\n\nSamothrace."]);
  assert.deepEqual(Object.keys(sent.at(-1)).sort(), ["material", "provenance"], "only changed fields are sent");
  const nothingIsUnsaved = () => page.getByRole("button", { name: "Discard unsaved texts" }).waitFor({ state: "hidden" });
  await nothingIsUnsaved();

  // A change that the form does not show, such as a note, is no conflict.
  await field("Material").fill("Parian marble");
  await asked(`/models/${id}`, { method: "PATCH", body: JSON.stringify({ presentation: { scale: 2 } }) });
  await save.click();
  await nothingIsUnsaved();
  assert.equal((await record()).material, "Parian marble");
  await page.reload(); // asks nothing, because all is saved
  await asked(`/models/${id}`, { method: "DELETE" });
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("a save that is repeated after a change elsewhere shows its error", async () => {
  const id = (await daemon.publish(scan, "Niobe")).split("/").pop();
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk;
  await desk.go(`models/${id}`, "Niobe");
  await page.getByLabel("DOI", { exact: true }).fill("10.5281/zenodo.1");
  await asked(`/models/${id}`, { method: "PATCH", body: JSON.stringify({ presentation: { scale: 2 } }) });
  const statuses = [], fault = { detail: "the DOI is taken", errors: [{ parameter: "metadata.doi", detail: "a new DOI" }] };
  let saves = 0;
  page.on("response", (response) => response.request().method() === "PATCH" && statuses.push(response.status()));
  await page.route(`**/api/v1/models/${id}`, (route) =>
    route.request().method() === "PATCH" && ++saves === 2 ? route.fulfill({ status: 400, json: fault }) : route.fallback());
  await desk.press("Save");
  await page.locator("[name=doi][aria-invalid]:focus ~ small", { hasText: "Expected: a new DOI" }).waitFor();
  const alert = page.getByRole("alert").filter({ hasText: "The DOI is taken" });
  await alert.waitFor();
  await desk.press("Save");
  await desk.says("Saved.");
  assert.deepEqual(statuses, [412, 400, 200]);
  await alert.waitFor({ state: "hidden" });
  assert.equal((await (await asked(`/models/${id}`)).json()).doi, "10.5281/zenodo.1");
  await asked(`/models/${id}`, { method: "DELETE" });
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("what is typed during a save is saved next, and is no conflict with the operator's own texts", async () => {
  const id = (await daemon.publish(scan, "Eros")).split("/").pop();
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk, save = page.getByRole("button", { name: "Save", exact: true });
  const field = (label) => page.getByLabel(label, { exact: true });
  await desk.go(`models/${id}`, "Eros");
  let proceed;
  const isHeld = new Promise((resolve) => (proceed = resolve));
  await page.route(`**/api/v1/models/${id}`, async (route) => {
    if (route.request().method() === "PATCH") await isHeld;
    await route.fallback();
  });
  await field("Material").fill("marble");
  await save.click();
  await field("Creator").fill("Praxiteles");
  assert.ok(await save.isDisabled(), "one save at a time");
  proceed();
  await desk.says("Saved.");
  assert.equal(await field("Creator").inputValue(), "Praxiteles");
  await save.click(); // waits until it is enabled
  await page.getByRole("button", { name: "Discard unsaved texts" }).waitFor({ state: "hidden" });
  const { material, creator } = await (await asked(`/models/${id}`)).json();
  assert.deepEqual([material, creator], ["marble", "Praxiteles"]);
  await asked(`/models/${id}`, { method: "DELETE" });
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("unsaved texts end with their model, and when the operator signs out", async () => {
  const [gone, kept] = [await daemon.publish(scan, "Eris"), await daemon.publish(scan, "Iris")].map((url) => url.split("/").pop());
  const desk = await Desk.open(browser, daemon, { token: operator }), { page } = desk, material = page.getByLabel("Material", { exact: true });
  const questions = [];
  page.on("dialog", async (dialog) => {
    questions.push(dialog.type());
    await dialog.accept();
  });

  // A colleague deletes the model.
  await desk.go(`models/${gone}`, "Eris");
  await material.fill("marble");
  await asked(`/models/${gone}`, { method: "DELETE" });
  await desk.go("jobs", "Jobs");
  await page.goto(`${daemon.url}/console#/models/${gone}`);
  await page.getByRole("button", { name: "Try again" }).waitFor();
  await desk.go("jobs", "Jobs");
  await page.reload();
  assert.deepEqual(questions, [], "nothing is unsaved");

  await desk.go(`models/${kept}`, "Iris");
  await material.fill("bronze");
  await desk.press("Sign out");
  await desk.press("Keep");
  assert.equal(await material.inputValue(), "bronze");
  await desk.press("Sign out");
  await desk.press("Discard and sign out");
  await desk.signIn(admin);
  await page.getByRole("heading", { level: 1, name: "Iris" }).waitFor();
  assert.equal(await material.inputValue(), "", "the next operator sees what is stored");
  await asked(`/models/${kept}`, { method: "DELETE" });
  assert.deepEqual(desk.complaints, []);
  await desk.close();
});

test("no other site can frame a page of the daemon, by whatever name, but the viewer", async () => {
  for (const path of ["/", "/index.html", "/console", "/console.html", "/docs", "/docs.html", "/scan.html"]) {
    const { headers } = await fetch(daemon.url + path);
    assert.equal(headers.get("x-frame-options"), "DENY", path);
    assert.match(headers.get("content-security-policy"), /frame-ancestors 'none'/, path);
  }
  assert.equal((await fetch(`${daemon.url}/model.html`)).headers.get("x-frame-options"), null);
});
