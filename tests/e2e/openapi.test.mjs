// SPDX-License-Identifier: Apache-2.0
// Tests the OpenAPI document of the real daemon. The document must be valid, the responses must
// conform to it, and the page /docs must show it without requests to other servers.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_SCREENSHOTS (a folder).
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdir } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { pathToFileURL } from "node:url";
import { launch, newContext } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const { Validator } = await import(pathToFileURL(require.resolve("@seriousme/openapi-schema-validator")));
const Ajv = require("ajv/dist/2020").default;
const addFormats = require("ajv-formats").default;
const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;

let daemon, api, model, token;

before(async () => {
  await mkdir(pictures, { recursive: true });
  daemon = await Daemon.start(bin);
  model = (await daemon.publish(scan, "Demosthenes")).split("/").pop();
  const words = ["token", "create", "--role", "admin", "--data", daemon.data, "--json"];
  token = JSON.parse((await promisify(execFile)(join(bin, "vitrine"), words)).stdout).token;
  api = await (await fetch(`${daemon.url}/api/v1/openapi.json`)).json();
});

after(() => daemon?.stop());

test("the document is valid OpenAPI 3.1", async () => {
  const validator = new Validator();
  const { valid, errors } = await validator.validate(structuredClone(api));
  assert.ok(valid, JSON.stringify(errors, null, 1));
  assert.equal(validator.version, "3.1");
});

/** Returns the errors by which `value` violates a schema of the document; an empty list if there are none. */
function faults(schema, value) {
  const ajv = new Ajv({ strict: false });
  addFormats(ajv);
  const check = ajv.addSchema({ $id: "api", components: api.components }).compile({ $ref: `api#/components/schemas/${schema}` });
  return check(value) ? [] : check.errors;
}

/** Fills in the parameters of a path. Returns null if this daemon has no resource for them. */
function target(path) {
  const filled = path.replace("{id}", model).replace("{format}", "ply");
  return filled.includes("{") || /^\/api\/v1\/(scans|jobs|uploads)\/./.test(path) ? null : filled;
}

test("answers are of the types and schemas that it tells", async () => {
  let compared = 0;
  const query = { "/api/v1/oembed": `?url=${encodeURIComponent(`${daemon.url}/models/${model}`)}`, "/api/v1/models/{id}/manifest": "?kbps=400&seconds=1" };
  for (const [path, { get }] of Object.entries(api.paths)) {
    const at = get && target(path);
    if (!at || path.endsWith("/stream")) continue;
    const answer = await fetch(daemon.url + at + (query[path] ?? ""), { headers: { Authorization: `Bearer ${token}` } });
    assert.equal(String(answer.status), Object.keys(get.responses)[0], path);
    const type = answer.headers.get("content-type").split(";")[0], { content } = get.responses[answer.status];
    assert.ok(content[type], `${path} is ${type}, but is described as ${Object.keys(content)}`);
    const { schema } = content[type];
    const body = Buffer.from(await answer.arrayBuffer());
    if (!schema.$ref) continue; // the response is not JSON
    assert.deepEqual(faults(schema.$ref.split("/").pop(), JSON.parse(body)), [], path);
    ++compared;
  }
  assert.ok(compared >= 9, `${compared} answers were compared`);
});

test("faults are problems", async () => {
  for (const at of ["/api/v1/models?limit=0", "/api/v1/nothing", "/api/v1/scanners", `/api/v1/models/${model}/manifest?kbps=1`]) {
    const answer = await fetch(daemon.url + at);
    assert.ok(answer.status >= 400, at);
    assert.equal(answer.headers.get("content-type"), "application/problem+json");
    assert.deepEqual(faults("Problem", await answer.json()), [], at);
  }
});

test("a schema refuses what is wrong", () => {
  assert.notDeepEqual(faults("Problem", { title: 1 }), []);
  assert.notDeepEqual(faults("ScanOrder", { scanner: "a", stepz: 3 }), []);
  assert.deepEqual(faults("ScanOrder", { scanner: "a", steps: 720, metadata: { title: "Bust" }, publish: true }), []);
});

test("the page shows every call and asks nobody else", async () => {
  const browser = await launch();
  try {
    const page = await (await newContext(browser, { viewport: { width: 1000, height: 900 } })).newPage();
    const asked = [], complaints = [];
    page.on("request", (request) => asked.push(new URL(request.url()).origin));
    page.on("pageerror", (error) => complaints.push(String(error)));
    await page.goto(`${daemon.url}/docs`);
    await page.locator("#getManifest").waitFor();
    const calls = Object.values(api.paths).flatMap((methods) => Object.values(methods));
    for (const { operationId, summary } of calls) {
      const text = await page.locator(`#${operationId}`).innerText();
      assert.ok(text.includes(summary.replaceAll("`", "")), operationId);
    }
    await page.screenshot({ path: join(pictures, "docs.png") });
    assert.deepEqual(complaints, []);
    assert.deepEqual([...new Set(asked.filter((origin) => origin !== "null"))], [daemon.url]);
  } finally {
    await browser.close();
  }
});

test("a model's page tells where it is described", async () => {
  const answer = await fetch(`${daemon.url}/models/${model}`), html = await answer.text();
  const [, oembed] = html.match(/<link rel="alternate" type="application\/json\+oembed"[^>]* href="([^"]+)">/);
  const { html: frame, title } = await (await fetch(oembed)).json();
  assert.equal(title, "Demosthenes");
  assert.ok(frame.includes(`src="${daemon.url}/models/${model}"`), frame);
  const [, iiif] = html.match(/<link rel="alternate" type="application\/ld\+json" href="([^"]+)">/);
  assert.equal((await (await fetch(iiif)).json()).label.none[0], "Demosthenes");
  const [, picture] = html.match(/<meta property="og:image" content="([^"]+)">/);
  assert.equal((await fetch(picture)).headers.get("content-type"), "image/png");
  assert.equal((await fetch(answer.url, { headers: { "If-None-Match": answer.headers.get("etag") } })).status, 304);
});

test("the collection shows posters", async () => {
  const browser = await launch();
  try {
    const page = await (await newContext(browser, { viewport: { width: 1000, height: 700 } })).newPage();
    await page.goto(daemon.url);
    await page.waitForFunction(() => document.querySelector("#models img")?.naturalWidth === 480);
    await page.screenshot({ path: join(pictures, "gallery-posters.png") });
  } finally {
    await browser.close();
  }
});
