// SPDX-License-Identifier: Apache-2.0
// Tests the daemon behind nginx with the shipped configuration.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file).
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { createHash } from "node:crypto";
import { once } from "node:events";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import https from "node:https";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { gunzipSync } from "node:zlib";
import { Daemon } from "./daemon.mjs";
import { Nginx } from "./nginx.mjs";

const run = promisify(execFile);
const { VITRINE_BIN: bin, VITRINE_MODEL: scan } = process.env;
let daemon, nginx, id, chunks, folder, ca;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vitrine-"));
  daemon = await Daemon.start(bin, ["--trusted-proxies", "127.0.0.1"]);
  id = (await daemon.publish(scan, "Demosthenes")).split("/").pop();
  nginx = await Nginx.start([`127.0.0.1:${daemon.port}`]);
  ca = await readFile(nginx.certificate);
  const { body } = await ask(`/api/v1/models/${id}/manifest`);
  chunks = JSON.parse(body).chunks.map(({ sha256 }) => sha256);
});

after(async () => {
  await nginx?.stop();
  await daemon?.stop();
  await rm(folder, { recursive: true, force: true });
});

/** Sends a request to nginx and returns the whole response. */
async function ask(path, headers = {}, method = "GET") {
  const request = https.request(nginx.url + path, { headers, method, ca, agent: false });
  request.on("error", () => undefined);  // an error after the response would otherwise end the test
  request.end();
  const [response] = await once(request, "response");
  const parts = await response.toArray();
  return { status: response.statusCode, headers: response.headers, body: Buffer.concat(parts) };
}

/** Runs the `vitrine` command, which trusts nginx's certificate. */
async function vitrine(...words) {
  const env = { PATH: process.env.PATH, SSL_CERT_FILE: nginx.certificate };
  const { stdout } = await run(join(bin, "vitrine"), [...words, "--json"], { env }).catch((failed) => failed);
  return JSON.parse(stdout);
}

/** Waits until the daemon has counted `count` requests for chunks. The daemon counts a request after sending its last byte. */
async function counted(count) {
  let now;
  do now = await daemon.chunkRequests();
  while (now < count);
  return now;
}

async function visit() {
  const answers = [];
  for (const sha256 of chunks) answers.push(await ask(`/api/v1/chunks/${sha256}`));
  return answers;
}

test("doctor finds nothing that keeps it from serving well", async () => {
  const { checks } = await vitrine("doctor", "--url", nginx.url);
  const by = Object.fromEntries(checks.map((one) => [one.check, one]));
  for (const check of ["server", "certificate", "server clock", "cors", "etag", "range", "caching", "websocket"])
    assert.equal(by[check]?.verdict, "ok", `${check}: ${by[check]?.detail}`);
});

test("five first visitors at once cost the origin one request a chunk, the next one none; chunks are immutable", async () => {
  const start = await daemon.chunkRequests();
  const [first, ...others] = await Promise.all(Array.from({ length: 5 }, visit));
  const misses = [first, ...others].flat().filter(({ headers }) => headers["x-cache"] === "MISS").length;
  assert.ok(misses > 0 && misses <= chunks.length, `${misses} of ${chunks.length}`);
  const once = await counted(start + misses);
  for (const [i, { status, headers, body }] of (await visit()).entries()) {
    assert.equal(status, 200);
    assert.equal(headers["x-cache"], "HIT");
    assert.equal(headers["cache-control"], "public, max-age=31536000, immutable");
    assert.equal(createHash("sha256").update(body).digest("hex"), chunks[i]);
    assert.deepEqual(body, first[i].body);
  }
  // This request goes directly to the daemon. It must be the only one that the daemon has counted
  // since `once`.
  await fetch(`${daemon.url}/api/v1/chunks/${chunks[0]}`);
  assert.equal(await counted(once + 1), once + 1);
});

test("ranges and conditions are answered from the cache as from the daemon", async () => {
  const path = `/api/v1/chunks/${chunks.at(-1)}`;
  const whole = await ask(path);
  const before = await daemon.chunkRequests();
  const part = await ask(path, { Range: "bytes=10-19" });
  assert.equal(part.status, 206);
  assert.equal(part.headers["content-range"], `bytes 10-19/${whole.body.length}`);
  assert.deepEqual(part.body, whole.body.subarray(10, 20));
  assert.equal((await ask(path, { "If-None-Match": whole.headers.etag })).status, 304);
  assert.equal((await ask(path, { "If-None-Match": '"another"' })).status, 200);
  await fetch(`${daemon.url}${path}`);
  assert.equal(await counted(before + 1), before + 1);
});

test("ranges of files and conditions on manifests reach the daemon", async () => {
  const path = `/api/v1/models/${id}/file.pmesh`;
  const part = await ask(path, { Range: "bytes=4-7" });
  assert.equal(part.status, 206);
  assert.deepEqual(part.body, (await ask(path)).body.subarray(4, 8));
  const manifest = `/api/v1/models/${id}/manifest`;
  const { headers } = await ask(manifest);
  assert.equal(headers["cache-control"], "no-cache");
  assert.equal((await ask(manifest, { "If-None-Match": headers.etag })).status, 304);
});

test("code passes through by gzip to who accepts it, each form with a tag of its own", async () => {
  const path = "/progressive-mesh.js", gzip = { "Accept-Encoding": "gzip" };
  const packed = await ask(path, gzip), plain = await ask(path);
  assert.equal(packed.headers["content-encoding"], "gzip");
  assert.equal(plain.headers["content-encoding"], undefined);
  assert.deepEqual(gunzipSync(packed.body), plain.body);
  assert.notEqual(packed.headers.etag, plain.headers.etag);
  for (const { headers } of [packed, plain]) assert.equal(headers.vary, "Accept-Encoding");
  assert.equal((await ask(path, { ...gzip, "If-None-Match": packed.headers.etag })).status, 304);
  assert.equal((await ask(path, { ...gzip, "If-None-Match": plain.headers.etag })).status, 200);
});

test("the addresses that the daemon tells are nginx's", async () => {
  const { body } = await ask(`/api/v1/iiif/${id}/manifest.json`);
  assert.equal(JSON.parse(body).id, `${nginx.url}/api/v1/iiif/${id}/manifest.json`);
});

test("a stream passes through, down to the last triangle", async () => {
  const [through, past] = ["through.ply", "past.ply"].map((name) => join(folder, name));
  await vitrine("fetch", `${nginx.url}/models/${id}`, "-o", through);
  await vitrine("fetch", `${daemon.url}/models/${id}`, "-o", past);
  assert.deepEqual(await readFile(through), await readFile(past));
});

test("a scan is published through it, and a body above 100 MB refused before it is sent", async () => {
  const words = ["token", "create", "--role", "operator", "--data", daemon.data];
  const { token } = await vitrine(...words);
  const published = await vitrine("publish", scan, "--server", nginx.url, "--token", token);
  assert.equal((await ask(`/api/v1/models/${published.id}`)).status, 200);
  const headers = { "Content-Length": String(100 * 1024 * 1024 + 1), Expect: "100-continue" };
  assert.equal((await ask("/api/v1/uploads", headers, "POST")).status, 413);
});

test("chunks that somebody has asked for are served while the origin is away", async () => {
  await visit();
  await daemon.stop();
  daemon = undefined;
  assert.deepEqual(new Set((await visit()).map(({ status }) => status)), new Set([200]));
  assert.equal((await ask(`/api/v1/models/${id}/manifest`)).status, 502);
});
