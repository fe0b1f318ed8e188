// SPDX-License-Identifier: Apache-2.0
// Tests the report of `vitrine build --report` in a real browser. The report must load no other file.
// Environment: VITRINE_BIN, VITRINE_MODEL (a mesh file), VITRINE_SCREENSHOTS.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdir, mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { launch, newContext } from "./browser.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;

let browser, folder, report;

before(async () => {
  await mkdir(pictures, { recursive: true });
  folder = await mkdtemp(join(tmpdir(), "report-"));
  report = join(folder, "report.html");
  execFileSync(join(bin, "vitrine"), ["build", scan, "-o", join(folder, "model.pmesh"), "--report", report]);
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await rm(folder, { recursive: true, force: true });
});

/** Opens the report. Returns the page, the URLs that it requests, and the browser's messages and errors. */
async function open(options) {
  const context = await newContext(browser, { viewport: { width: 1180, height: 900 }, ...options });
  const page = await context.newPage();
  const requests = [], complaints = [];
  page.on("request", (request) => request.url().startsWith("data:") || requests.push(request.url()));
  page.on("console", (message) => complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(pathToFileURL(report).href);
  return { page, requests, complaints };
}

for (const colorScheme of ["light", "dark"]) {
  test(`the report shows itself in ${colorScheme} and asks for nothing`, async () => {
    const { page, requests, complaints } = await open({ colorScheme });
    await page.screenshot({ path: join(pictures, `report-${colorScheme}.png`), fullPage: true });
    const widths = await page.locator("img").evaluateAll((images) => images.map((image) => image.naturalWidth));
    assert.equal(widths.length, 5);
    assert.ok(widths.every((width) => width > 100), `${widths}`);
    assert.ok(await page.locator("svg circle title").count() > 10);
    const paper = await page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number));
    assert.equal(paper[0] > 128, colorScheme === "light");
    assert.deepEqual(requests, [pathToFileURL(report).href]);
    assert.deepEqual(complaints, []);
  });
}

test("the report fits a phone without scrolling sideways", async () => {
  const { page } = await open({ viewport: { width: 360, height: 740 } });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
});
