// SPDX-License-Identifier: Apache-2.0
// Opens the operator's console in a browser, performs actions like an operator, and checks the
// console's pages.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { promisify } from "node:util";
import { newContext } from "./browser.mjs";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const axe = await readFile(require.resolve("axe-core/axe.min.js"), "utf8");
const pictures = process.env.VITRINE_SCREENSHOTS;

/** Creates a token on the command line, as an administrator does on the daemon's machine. */
export async function tokenFor(daemon, role) {
  const words = ["token", "create", "--role", role, "--data", daemon.data, "--json"];
  return JSON.parse((await promisify(execFile)(join(daemon.bin, "vitrine"), words)).stdout).token;
}

/** Returns the violations that axe-core finds on the page, one line each. The viewer is excluded, because its own test checks it. */
export async function violations(page) {
  await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run({ exclude: ["progressive-mesh"] }, { resultTypes: ["violations"] }));
  return found.violations.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target} ${failureSummary}`));
}

/** Returns the number of pixels by which the page is wider than its window. */
export function overflow(page) {
  return page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
}

export class Desk {
  /** Opens the console. `play(context)` is called first. It may install routes that respond instead of the daemon. */
  static async open(browser, daemon, { token, play, ...options } = {}) {
    const context = await newContext(browser, { viewport: { width: 1280, height: 860 }, reducedMotion: "reduce", ...options });
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
    // The browser also reports each failed response as an error. Ignores these errors, because the
    // console handles failed responses.
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

  /** Drags a file onto the page, as from the desktop. */
  drop(name, bytes) {
    return this.dropAll([[name, bytes]]);
  }

  /** Drags several files, each given as [name, bytes], onto the page at once. */
  async dropAll(list) {
    const files = await this.page.evaluateHandle((encoded) => {
      const transfer = new DataTransfer();
      for (const [title, text] of encoded)
        transfer.items.add(new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], title, { lastModified: 1 }));
      return transfer;
    }, list.map(([name, bytes]) => [name, bytes.toString("base64")]));
    await this.page.locator(".drop").first().dispatchEvent("drop", { dataTransfer: files });
  }

  /**
   * Checks that the page fits into windows of width 360, 768 and 1920 pixels and has no
   * accessibility violations. Takes screenshots.
   */
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
