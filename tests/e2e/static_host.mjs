// SPDX-License-Identifier: Apache-2.0
// A host that knows nothing of Vitrine: the viewer's files, a model file and a page that shows it.
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";

const dist = new URL("../../web/dist/", import.meta.url);
const kTypes = { js: "text/javascript", wasm: "application/wasm", html: "text/html" };

export class StaticHost {
  /** `range`: parts of files are served; `cors`: pages of other origins may read them. */
  static async start({ range = true, cors = false } = {}) {
    const host = new StaticHost(range, cors);
    host.server.listen(0, "127.0.0.1");
    await once(host.server, "listening");
    host.url = `http://127.0.0.1:${host.server.address().port}`;
    return host;
  }

  files = new Map();
  asked = []; // "GET /model.pmesh bytes=0-32767"

  constructor(range, cors) {
    Object.assign(this, { range, cors });
    this.server = createServer((request, response) => this.#answer(request, response).catch(() => response.writeHead(404).end()));
  }

  /** The address of a page with one viewer that has these attributes. */
  page(attributes) {
    const words = Object.entries(attributes).map(([name, value]) => `${name}="${value}"`).join(" ");
    return this.add(`page${this.files.size}.html`, `<!doctype html><link rel="icon" href="data:,"><script type="module" src="/progressive-mesh.js">
      </script><style>progressive-mesh { height: 600px }</style><progressive-mesh ${words}></progressive-mesh>`);
  }

  add(name, content) {
    this.files.set(`/${name}`, Buffer.from(content));
    return `${this.url}/${name}`;
  }

  stop() {
    this.server.closeAllConnections();
    this.server.close();
  }

  async #answer({ url, method, headers }, response) {
    this.asked.push([method, url, headers.range].filter(Boolean).join(" "));
    const path = url.replace(/\?.*/, "");
    const body = this.files.get(path) ?? (await readFile(new URL(`.${path}`, dist)));
    const type = { "Content-Type": kTypes[path.split(".").pop()] ?? "application/octet-stream" };
    const open = this.cors ? { "Access-Control-Allow-Origin": "*" } : {};
    const [, first, last] = (this.range && /^bytes=(\d+)-(\d+)$/.exec(headers.range ?? "")) || [];
    if (first === undefined) return void response.writeHead(200, { ...type, ...open }).end(body);
    const part = body.subarray(Number(first), Number(last) + 1);
    const place = { "Content-Range": `bytes ${first}-${Number(first) + part.length - 1}/${body.length}` };
    response.writeHead(206, { ...type, ...open, ...place }).end(part);
  }
}
