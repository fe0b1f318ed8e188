// SPDX-License-Identifier: Apache-2.0
// The operator's console in a browser, and what a test wants to know of it.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { promisify } from "node:util";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const axe = await readFile(require.resolve("axe-core/axe.min.js"), "utf8");
const pictures = process.env.VITRINE_SCREENSHOTS;

/** A new token of the daemon's, made as on its own machine. */
export async function tokenFor(daemon, role) {
  const words = ["token", "create", "--role", role, "--data", daemon.data, "--json"];
  return JSON.parse((await promisify(execFile)(join(daemon.bin, "vitrine"), words)).stdout).token;
}

/** What axe-core has to say about a page as it is, in one line each. The viewer is looked at by its own test. */
export async function violations(page) {
  await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run({ exclude: ["progressive-mesh"] }, { resultTypes: ["violations"] }));
  return found.violations.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target} ${failureSummary}`));
}

/** Pixels by which the page is wider than its window. */
export function overflow(page) {
  return page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
}

export class Desk {
  /** `play(context)` may answer in the daemon's place. */
  static async open(browser, daemon, { token, play, ...options } = {}) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 860 }, reducedMotion: "reduce", ...options });
    await play?.(context);
    const desk = new Desk(await context.newPage(), daemon);
    await desk.page.goto(`${daemon.url}/console`);
    if (token) await desk.signIn(token);
    return desk;
  }

  complaints = [];

  constructor(page, daemon) {
    Object.assign(this, { page, daemon });
    page.on("pageerror", (error) => this.complaints.push(String(error)));
    // A browser tells of each answer that is no success, too: the console knows what to make of them.
    page.on("console", (message) => message.type() === "error" && !/Failed to load resource/.test(message.text()) && this.complaints.push(message.text()));
  }

  async signIn(token) {
    await this.page.getByLabel("Access token").fill(token);
    await this.page.getByRole("button", { name: "Sign in" }).click();
    await this.page.getByRole("navigation").getByRole("link").first().waitFor();
  }

  async go(section, heading) {
    await this.page.goto(`${this.daemon.url}/console#/${section}`);
    await this.page.getByRole("heading", { level: 1, name: heading }).waitFor();
  }

  press(name, scope = this.page) {
    return scope.getByRole("button", { name, exact: true }).click();
  }

  says(text) {
    return this.page.getByText(text, { exact: false }).first().waitFor({ timeout: 60_000 });
  }

  /** Drags a file out of nowhere onto the page. */
  async drop(name, bytes) {
    const files = await this.page.evaluateHandle(([title, text]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], title, { lastModified: 1 }));
      return transfer;
    }, [name, bytes.toString("base64")]);
    await this.page.locator(".drop").first().dispatchEvent("drop", { dataTransfer: files });
  }

  /** Fit for everybody at all widths in the colours that it has now. */
  async isFit(name) {
    for (const width of [360, 768, 1920]) {
      await this.page.setViewportSize({ width, height: width === 360 ? 740 : 1080 });
      if (pictures) await this.page.screenshot({ path: join(pictures, `console-${name}-${width}.png`), animations: "disabled" });
      assert.ok((await overflow(this.page)) <= 0, `${name} is wider than ${width} pixels`);
    }
    assert.deepEqual(await violations(this.page), [], name);
  }

  close() {
    return this.page.context().close();
  }
}
