// SPDX-License-Identifier: Apache-2.0
// A static web host with a folder of built files and a model, which sends a security policy with every response.
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { join } from "node:path";

const kTypes = { js: "text/javascript", wasm: "application/wasm", html: "text/html", css: "text/css" };
export const kModel = new URL("../../golden/parts_regions_coloured.pmesh", import.meta.url);
const kStyle = "progressive-mesh { display: block; width: 300px; height: 300px }";

/** Returns the HTML of a page that loads the script /NAME.js. */
export const pageOf = (name) => `<!doctype html><link rel="icon" href="/style.css"><link rel="stylesheet" href="/style.css">
  <title>${name}</title><body><script type="module" src="/${name}.js"></script>`;

/** Serves `folder`. The page /NAME.html loads the script /NAME.js. Returns { url, close }. */
export async function serve(folder, policy) {
  const model = await readFile(kModel);
  const server = createServer(async ({ url }, response) => {
    const [, name, extension] = /^\/(.*)\.(\w+)$/.exec(url) ?? [];
    const own = { html: pageOf(name), pmesh: model, css: kStyle }[extension];
    const body = own ?? (await readFile(join(folder, url)).catch(() => undefined));
    const fields = { "Content-Type": kTypes[extension] ?? "application/octet-stream", ...(policy && { "Content-Security-Policy": policy }) };
    response.writeHead(body ? 200 : 404, fields).end(body);
  });
  server.listen(0, "127.0.0.1");
  await once(server, "listening");
  const close = () => {
    server.closeAllConnections();
    server.close();
  };
  return { url: `http://127.0.0.1:${server.address().port}/`, close };
}
