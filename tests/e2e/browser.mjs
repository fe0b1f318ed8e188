// SPDX-License-Identifier: Apache-2.0
// Debian's Chromium, and what a test wants to know of a viewer page.
import { createRequire } from "node:module";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const { chromium } = require("playwright-core");

export function launch() {
  return chromium.launch({
    executablePath: process.env.VITRINE_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
           "--disable-component-update", "--disable-sync"],
  });
}

const kEvents = ["first-paint", "refine", "progress", "load", "error", "camera-change"];

/** Sets attributes of each viewer as soon as the page has it. */
function dress(attributes) {
  new MutationObserver(() => {
    for (const viewer of document.querySelectorAll("progressive-mesh:not([data-dressed])")) {
      viewer.dataset.dressed = "";
      for (const [name, value] of Object.entries(attributes)) viewer.setAttribute(name, value);
    }
  }).observe(document, { childList: true, subtree: true });
}

/** A page with one <progressive-mesh>, its events, requests and complaints. */
export class ViewerPage {
  /**
   * `init` runs in the page before its own scripts. `attributes` are the viewer's, before it is one: with none
   * it shows all there is.
   */
  static async open(browser, url, {
    colorScheme = "light", reducedMotion = "reduce", width = 1100, height = 760, init, attributes = { "pixel-error": "0" },
  } = {}) {
    const context = await browser.newContext({ viewport: { width, height }, colorScheme, reducedMotion });
    const viewer = new ViewerPage(await context.newPage());
    await viewer.#listen();
    if (init) await viewer.page.addInitScript(init);
    await viewer.page.addInitScript(dress, attributes);
    await viewer.page.goto(url, { waitUntil: "commit" });
    return viewer;
  }

  errors = [];
  held = [];
  holding = true;
  askedChunks = 0; // exact once their effect is seen: each request passes through here
  origins = []; // of all requests
  finishedChunks = 0; // as the browser tells: may lag behind what the page shows

  constructor(page) {
    this.page = page;
  }

  /** Lets the requests for enhancement layers go, those held so far and all later ones. */
  async releaseLayers() {
    this.holding = false;
    await Promise.all(this.held.splice(0).map((route) => route.continue()));
  }

  /** Waits until `type` has been fired `count` times since the page began; returns all details. */
  async events(type, count = 1) {
    await this.page.waitForFunction(([name, n]) => window.seen.filter((event) => event.type === name).length >= n,
      [type, count], { timeout: 60_000 });
    return (await this.seen()).filter((event) => event.type === type);
  }

  seen() {
    return this.page.evaluate(() => window.seen);
  }

  /** Does `action` and waits for the state it leads to. */
  async settled(action) {
    const before = (await this.seen()).filter(({ type }) => type === "load").length;
    await action();
    await this.events("load", before + 1);
  }

  slide(fraction) {
    return this.settled(() => this.page.locator("input[name=detail]").evaluate((slider, value) => {
      slider.value = String(value);
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    }, Math.round(1000 * fraction)));
  }

  /** Does `action` and waits until more than `count` triangles are shown and that is reported as reached. */
  async sharpened(count, action) {
    await action();
    await this.page.waitForFunction((few) => {
      const finer = window.seen.findIndex(({ type, detail }) => type === "refine" && detail.triangles > few);
      return finer >= 0 && window.seen.slice(finer).some(({ type }) => type === "load");
    }, count, { timeout: 60_000 });
  }

  /** Opens the sheet of a tool, unless it is open. */
  async sheet(tool) {
    const button = this.page.locator(`button[name=${tool}]`);
    await button.waitFor();
    if (await button.getAttribute("aria-expanded") === "false") await button.click();
  }

  /** The switch of that name, in its open sheet. */
  async toggle(name) {
    await this.sheet("surface");
    return this.page.locator(`input[name=${name}]`);
  }

  async triangles() {
    const shown = (await this.seen()).filter(({ type }) => type === "refine");
    return shown.at(-1).detail.triangles;
  }

  /** What stands in the panel. */
  async counts() {
    return this.page.locator("output .triangles").textContent();
  }

  /** Two frames: what was asked for before is drawn. */
  frames() {
    return this.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }

  /** The element as it stands still: transitions of its controls are at their end. */
  async picture(path) {
    await this.frames();
    return this.page.locator("progressive-mesh").screenshot({ path, animations: "disabled" });
  }

  /** What the browser has complained of up to now. */
  async complaints() {
    await this.frames(); // the answer comes after the messages before it
    return this.errors;
  }

  async #listen() {
    const { page } = this;
    page.on("pageerror", (error) => this.errors.push(String(error)));
    page.on("console", (message) => message.type() === "error" && this.errors.push(message.text()));
    page.on("request", (request) => request.url().startsWith("http") && this.origins.push(new URL(request.url()).origin));
    page.on("requestfinished", (request) => request.url().includes("/chunks/") && ++this.finishedChunks);
    await page.context().route("**/api/v1/chunks/*", (route) => {
      ++this.askedChunks;
      return this.holding ? void this.held.push(route) : route.continue();
    });
    await page.addInitScript((types) => {
      window.seen = [];
      for (const type of types) {
        const keep = (event) => event.target.localName === "progressive-mesh" && window.seen.push({ type, detail: event.detail });
        document.addEventListener(type, keep, true);
      }
    }, kEvents);
  }
}
