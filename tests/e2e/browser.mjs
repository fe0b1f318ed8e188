// SPDX-License-Identifier: Apache-2.0
// Starts Debian's Chromium, and helps tests to use pages with a viewer.
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

// Timeout of an action in milliseconds. It is long, because drawing and compiling may keep both
// cores busy.
const kActionTimeout = 120_000;

/** Returns a new browser context without cookies or cache, like a private window. */
export async function newContext(browser, options) {
  const context = await browser.newContext(options);
  context.setDefaultTimeout(kActionTimeout);
  return context;
}

const kEvents = ["first-paint", "refine", "picture", "memory", "progress", "load", "error", "camera-change", "tour-step"];

/**
 * Runs in the page: sets `attributes` on each <progressive-mesh> as soon as it is in the document. Sets `style` as a property,
 * because the content security policy of the daemon's pages forbids the attribute.
 */
function dress(attributes) {
  new MutationObserver(() => {
    for (const viewer of document.querySelectorAll("progressive-mesh:not([data-dressed])")) {
      viewer.dataset.dressed = "";
      const { style = "", ...others } = attributes;
      if (style) viewer.style.cssText = style;
      for (const [name, value] of Object.entries(others)) viewer.setAttribute(name, value);
    }
  }).observe(document, { childList: true, subtree: true });
}

/** A page with one <progressive-mesh>. Records the page's events, requests and errors. */
export class ViewerPage {
  /**
   * Opens the page at `url`. `init` runs in the page before the page's own scripts. `attributes`
   * are set on the element before it is defined. By default, the element shows the whole model.
   */
  static async open(browser, url, {
    colorScheme = "light", reducedMotion = "reduce", width = 1100, height = 760, init, attributes = { "pixel-error": "0" },
  } = {}) {
    const context = await newContext(browser, { viewport: { width, height }, colorScheme, reducedMotion });
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
  askedChunks = 0; // number of requests for chunks, counted by the route handler below
  origins = []; // origins of all HTTP requests
  // Number of completed requests for chunks. The browser may report a completion later than the
  // page shows the result.
  finishedChunks = 0;

  constructor(page) {
    this.page = page;
  }

  /** Continues the held requests for enhancement layers. Later requests are not held. */
  async releaseLayers() {
    this.holding = false;
    await Promise.all(this.held.splice(0).map((route) => route.continue()));
  }

  /** Waits until the event `type` has been fired `count` times since the page was loaded. Returns the recorded events of that type. */
  async events(type, count = 1) {
    await this.page.waitForFunction(([name, n]) => window.seen.filter((event) => event.type === name).length >= n,
      [type, count], { timeout: 60_000 });
    return (await this.seen()).filter((event) => event.type === type);
  }

  seen() {
    return this.page.evaluate(() => window.seen);
  }

  /** Performs `action` and waits for the next `load` event, which says that the requested detail is shown. */
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

  /**
   * Performs `action`. Waits until more than `count` triangles are shown and a `load` event has
   * been fired afterwards.
   */
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

  /** Opens the sheet "surface" and returns its switch `name`. */
  async toggle(name) {
    await this.sheet("surface");
    return this.page.locator(`input[name=${name}]`);
  }

  async triangles() {
    const shown = (await this.seen()).filter(({ type }) => type === "refine");
    return shown.at(-1).detail.triangles;
  }

  /** Returns the text in which the panel states the number of triangles. */
  async counts() {
    return this.page.locator("output .triangles").textContent();
  }

  /** Waits for two animation frames. By then, the page has drawn all earlier changes. */
  frames() {
    return this.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }

  /** Takes a screenshot of the element after the transitions of its controls have finished. */
  async picture(path) {
    await this.frames();
    return this.page.locator("progressive-mesh").screenshot({ path, animations: "disabled" });
  }

  /** Returns the errors that the browser has reported so far. */
  async complaints() {
    // Calls the page and waits for the reply, which arrives after all earlier messages of the page.
    await this.frames();
    return this.errors;
  }

  /** Makes the viewer lose its WebGL context and get it back. */
  async loseContext() {
    await this.page.evaluate(async () => {
      const place = document.querySelector("progressive-mesh").shadowRoot.querySelector("canvas");
      const context = place.getContext("webgl2").getExtension("WEBGL_lose_context");
      const heard = (type) => new Promise((resolve) => place.addEventListener(type, resolve, { once: true }));
      const lost = heard("webglcontextlost");
      context.loseContext();
      await lost;
      // Waits one frame, because a lost context can be restored only after its event has been
      // handled.
      await new Promise(requestAnimationFrame);
      const restored = heard("webglcontextrestored");
      context.restoreContext();
      await restored;
    });
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
