// SPDX-License-Identifier: Apache-2.0
// A static web host with the viewer's files, a model file and pages that show the model.
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { promisify } from "node:util";
import { gzip } from "node:zlib";

const dist = new URL("../../web/dist/", import.meta.url);
const kTypes = { js: "text/javascript", wasm: "application/wasm", html: "text/html" };

export class StaticHost {
  /**
   * Starts a host. With `range`, it supports Range requests. With `cors`, it allows pages of other origins. With
   * `tuned`, it compresses code and lets browsers cache it.
   */
  static async start({ range = true, cors = false, tuned = false } = {}) {
    const host = new StaticHost({ range, cors, tuned });
    host.server.listen(0, "127.0.0.1");
    await once(host.server, "listening");
    host.url = `http://127.0.0.1:${host.server.address().port}`;
    return host;
  }

  files = new Map();
  asked = []; // all requests so far, as texts such as "GET /model.pmesh bytes=0-32767"
  sent = []; // all responses so far, as { path, bytes, at }; `at` is the time of the request in ms since 1970

  constructor(options) {
    Object.assign(this, options);
    this.server = createServer((request, response) => this.#answer(request, response).catch(() => response.writeHead(404).end()));
  }

  /** Adds a page with one viewer that has the given attributes. Returns the page's URL. */
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
    const path = url.replace(/\?.*/, ""), at = Date.now();
    const body = this.files.get(path) ?? (await readFile(new URL(`.${path}`, dist)));
    const type = { "Content-Type": kTypes[path.split(".").pop()] ?? "application/octet-stream" };
    const open = this.cors ? { "Access-Control-Allow-Origin": "*" } : {};
    const [, first, last] = (this.range && /^bytes=(\d+)-(\d+)$/.exec(headers.range ?? "")) || [];
    const end = (status, fields, bytes) => {
      this.sent.push({ path, bytes: bytes.length, at });
      response.writeHead(status, { ...type, ...open, ...fields }).end(bytes);
    };
    if (first === undefined) {
      if (!this.tuned || !/^(text|application\/wasm)/.test(type["Content-Type"])) return end(200, {}, body);
      const fields = { "Content-Encoding": "gzip", ...(path.endsWith("html") ? {} : { "Cache-Control": "max-age=31536000, immutable" }) };
      return end(200, fields, await promisify(gzip)(body, { level: 9 }));
    }
    const part = body.subarray(Number(first), Number(last) + 1);
    const place = { "Content-Range": `bytes ${first}-${Number(first) + part.length - 1}/${body.length}` };
    end(206, place, part);
  }
}
