// SPDX-License-Identifier: Apache-2.0
// Opens a web page in Chromium. The page has its own origin, and esbuild bundles its script with the pinned packages of this
// folder.
import { once } from "node:events";
import { mkdirSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { launch, newContext } from "../e2e/browser.mjs";

const here = fileURLToPath(new URL("./", import.meta.url));
const web = fileURLToPath(new URL("../../web/", import.meta.url)), viewer = join(web, "dist/package");
const kTypes = { js: "text/javascript", wasm: "application/wasm", html: "text/html" };
const kHtml = `<!doctype html><link rel="icon" href="data:,"><title>Client</title>
  <style>body { margin: 0; display: flex } canvas, progressive-mesh, model-viewer { display: block; flex: none; width: 400px; height: 400px }
    progressive-mesh, model-viewer { height: 600px }</style>
  <body><script type="module" src="/page.js"></script>`;

export class ClientPage {
  /**
   * Opens a page with the script pages/NAME.js. In the script's imports, `alias` replaces names of packages. The page's server
   * answers /NAME/… with files of `folders[NAME]`, and other paths with files of the npm package of the viewer.
   */
  static async open(name, { alias = {}, folders = {} } = {}) {
    const client = new ClientPage();
    client.server = await serve(await bundled(name, alias), folders);
    client.browser = await launch();
    const context = await newContext(client.browser, { viewport: { width: 1200, height: 600 } });
    client.page = await context.newPage();
    client.errors = [];
    client.page.on("pageerror", (error) => client.errors.push(String(error)));
    client.page.on("console", (message) => message.type() === "error" && client.errors.push(message.text()));
    await client.page.goto(`http://127.0.0.1:${client.server.address().port}/`);
    await client.page.waitForFunction(() => window.client !== undefined);
    return client;
  }

  /** Calls the function `name` of the page's object `client`. */
  call(name, ...words) {
    return this.page.evaluate(([method, rest]) => window.client[method](...rest), [name, words]);
  }

  /** Saves a picture of the page as VITRINE_SCREENSHOTS/clients-NAME.png. Returns its bytes. */
  screenshot(name) {
    const folder = process.env.VITRINE_SCREENSHOTS;
    mkdirSync(folder, { recursive: true });
    return this.page.screenshot({ path: join(folder, `clients-${name}.png`) });
  }

  async close() {
    await this.browser?.close();
    this.server?.closeAllConnections();
    this.server?.close();
  }
}

async function bundled(name, alias) {
  const { outputFiles } = await build({
    entryPoints: [join(here, "pages", `${name}.js`)], absWorkingDir: here, bundle: true, write: false, format: "esm", logLevel: "error",
    alias: {
      "@vitrine/progressive-mesh": join(viewer, "progressive-mesh-loader.js"), "@vitrine/progressive-mesh/element": join(viewer, "progressive-mesh.js"),
      "@google/model-viewer": join(web, "node_modules/@google/model-viewer/dist/model-viewer.min.js"), ...alias,
    },
  });
  return outputFiles[0].contents;
}

async function serve(script, folders) {
  const server = createServer(async ({ url }, response) => {
    const [, first, rest] = /^\/([^/]+)\/(.*)$/.exec(url) ?? [];
    const own = { "/": kHtml, "/page.js": script }[url];
    const body = own ?? (await readFile(first in folders ? join(folders[first], rest) : join(viewer, url)).catch(() => undefined));
    response.writeHead(body ? 200 : 404, { "Content-Type": kTypes[url === "/" ? "html" : url.split(".").pop()] ?? "application/octet-stream" }).end(body);
  });
  server.listen(0, "127.0.0.1");
  await once(server, "listening");
  return server;
}

/** Returns the folder of an installed package. */
export const packageFolder = (name) => join(here, "node_modules", name);
