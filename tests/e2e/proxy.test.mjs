// SPDX-License-Identifier: Apache-2.0
// Tests the daemon behind nginx with the shipped configuration.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file).
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { createHash } from "node:crypto";
import { once } from "node:events";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import http, { createServer } from "node:http";
import https from "node:https";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { connect } from "node:tls";
import { promisify } from "node:util";
import { gunzipSync } from "node:zlib";
import { Daemon } from "./daemon.mjs";
import { freePort, Nginx } from "./nginx.mjs";

const run = promisify(execFile);
const { VITRINE_BIN: bin, VITRINE_MODEL: scan } = process.env;
let daemon, nginx, purgePort, id, chunks, folder, ca; // nginx listens at purgePort in one test only

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vitrine-"));
  purgePort = await freePort();
  daemon = await Daemon.start(bin, ["--trusted-proxies", "127.0.0.1", "--purge-urls", `http://127.0.0.1:${purgePort}`]);
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
function ask(path, headers = {}, method = "GET") {
  return get(nginx.url + path, { headers, method, ca, agent: false });
}

async function get(url, options) {
  const request = (url.startsWith("https:") ? https : http).request(url, options);
  request.on("error", () => undefined);  // an error after the response would otherwise end the test
  request.end();
  const [response] = await once(request, "response");
  const parts = await response.toArray();
  return { status: response.statusCode, headers: response.headers, body: Buffer.concat(parts) };
}

/**
 * An origin that forwards requests to the daemon. It sets the lifetimes for shared caches in
 * Cache-Control (s-maxage, stale-while-revalidate) to `seconds`, so that a test decides whether
 * responses expire.
 */
class OtherOrigin {
  bytes = 0; // total size of the bodies with status 200
  confirmed = 0; // number of responses with status 304
  fault = undefined; // if set, the HTTP status of all responses

  static async start(to, seconds) {
    const origin = new OtherOrigin();
    origin.server = createServer((request, response) => origin.#forward(to, seconds, request, response)).listen(0, "127.0.0.1");
    await once(origin.server, "listening");
    origin.port = origin.server.address().port;
    return origin;
  }

  async #forward(to, seconds, { url, method, headers }, response) {
    if (this.fault) return response.writeHead(this.fault).end();
    const request = http.request({ host: "127.0.0.1", port: to, path: url, method, headers, agent: false }).end();
    const [answer] = await once(request, "response");
    const body = Buffer.concat(await answer.toArray());
    if (answer.statusCode === 200) this.bytes += body.length;
    if (answer.statusCode === 304) this.confirmed += 1;
    const caching = answer.headers["cache-control"].replace(/(s-maxage|stale-while-revalidate)=[0-9]+/g, `$1=${seconds}`);
    response.writeHead(answer.statusCode, { ...answer.headers, "cache-control": caching }).end(body);
  }

  async stop() {
    this.server.close();
    this.server.closeAllConnections();
    await once(this.server, "close");
  }
}

/** Runs the `vitrine` command, which trusts nginx's certificate. */
async function vitrine(...words) {
  const env = { PATH: process.env.PATH, SSL_CERT_FILE: nginx.certificate };
  const { stdout } = await run(join(bin, "vitrine"), [...words, "--json"], { env }).catch((failed) => failed);
  return JSON.parse(stdout);
}

/** Publishes or unpublishes the model. Sends the request directly to the daemon, not to nginx. */
async function change(verb) {
  const { token } = await vitrine("token", "create", "--role", "operator", "--data", daemon.data);
  return fetch(`${daemon.url}/api/v1/models/${id}/${verb}`, { method: "POST", headers: { Authorization: `Bearer ${token}` } });
}

/**
 * Waits until the daemon has counted `count` requests for chunks. The daemon counts a request after sending the last byte of
 * the response.
 */
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
    assert.match(headers["cache-control"], /^public, max-age=31536000, immutable, s-maxage=120, stale-while-revalidate=60$/);
    assert.equal(createHash("sha256").update(body).digest("hex"), chunks[i]);
    assert.deepEqual(body, first[i].body);
  }
  // Sends one request directly to the daemon. This request must be the only one that the daemon
  // counts after `once`.
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

test("nginx speaks TLS 1.2 and 1.3 only, and resumes sessions", async () => {
  const greet = async (options) => {
    const socket = connect({ port: nginx.port, host: "127.0.0.1", servername: "localhost", ca, ...options });
    try {
      await once(socket, "secureConnect");
      return { protocol: socket.getProtocol(), session: socket.getSession(), resumed: socket.isSessionReused() };
    } finally {
      socket.destroy();
    }
  };
  const both = { minVersion: "TLSv1", ciphers: "DEFAULT@SECLEVEL=0" };
  assert.equal((await greet(both)).protocol, "TLSv1.3");
  const { protocol, session } = await greet({ ...both, maxVersion: "TLSv1.2" });
  assert.equal(protocol, "TLSv1.2");
  assert.ok((await greet({ maxVersion: "TLSv1.2", session })).resumed);
  await assert.rejects(greet({ ...both, maxVersion: "TLSv1.1" }));
});

test("browsers keep to HTTPS, and other host names get no answer", async () => {
  for (const path of ["/", `/models/${id}`, `/api/v1/chunks/${chunks[0]}`, "/nothing"])
    assert.equal((await ask(path)).headers["strict-transport-security"], "max-age=31536000", path);
  const from = (get, url, more) => once(get(url, { ca, agent: false, ...more }), "response");
  const headers = { Host: "attacker.example" };
  await assert.rejects(from(https.get, nginx.url, { headers, servername: "attacker.example" }), { code: "EPROTO" });
  await assert.rejects(from(https.get, nginx.url, { headers, servername: "localhost" }), { code: "ECONNRESET" });
  const plain = `http://localhost:${nginx.plainPort}/`;
  assert.equal((await from(http.get, plain))[0].statusCode, 308);
  await assert.rejects(from(http.get, plain, { headers }), { code: "ECONNRESET" });
});

test("one address has a bounded number of requests under way", async () => {
  const origin = createServer(() => undefined).listen(0, "127.0.0.1");
  await once(origin, "listening");
  const front = await Nginx.start([`127.0.0.1:${origin.address().port}`], [["limit_conn vitrine_addresses 200;", "limit_conn vitrine_addresses 2;"]]);
  try {
    const options = { ca: await readFile(front.certificate), agent: false };
    for (let i = 0; i < 2; ++i) {
      https.get(front.url, options).on("error", () => undefined);
      await once(origin, "request");
    }
    assert.equal((await get(front.url, options)).status, 429);
  } finally {
    origin.closeAllConnections();
    origin.close();
    await front.stop();
  }
});

test("an IPv6 visitor counts by the network, whose addresses are all the visitor's", async () => {
  const origin = createServer(() => undefined).listen(0, "127.0.0.1");
  await once(origin, "listening");
  const front = await Nginx.start([`127.0.0.1:${origin.address().port}`], [
    ["limit_conn vitrine_addresses 200;", "limit_conn vitrine_addresses 1; set_real_ip_from 127.0.0.1; real_ip_header X-Visitor;"]]);
  try {
    const ca = await readFile(front.certificate);
    const from = (address) => ({ ca, agent: false, headers: { "X-Visitor": address } });
    for (const address of ["2001:db8:0:1::a0a", "2001:db8:0:2::1", "192.0.2.1", "192.0.2.2"]) {
      https.get(front.url, from(address)).on("error", () => undefined);
      await once(origin, "request");
    }
    for (const address of ["2001:db8:0:1:ffff::2", "2001:db8:0:2::1", "192.0.2.1"])
      assert.equal((await get(front.url, from(address))).status, 429, address);
  } finally {
    origin.closeAllConnections();
    origin.close();
    await front.stop();
  }
});

test("a stream passes through, down to the last triangle", async () => {
  const [through, past] = ["through.ply", "past.ply"].map((name) => join(folder, name));
  await vitrine("fetch", `${nginx.url}/models/${id}`, "--force", "-o", through);
  await vitrine("fetch", `${daemon.url}/models/${id}`, "--force", "-o", past);
  assert.deepEqual(await readFile(through), await readFile(past));
});

test("a purged chunk is gone, though its time is not over, and comes back once it is public again", async () => {
  const slow = await OtherOrigin.start(daemon.port, 86400);
  const front = await Nginx.start([`127.0.0.1:${slow.port}`]);
  try {
    const path = `/api/v1/chunks/${chunks.at(-1)}`;
    const options = { ca: await readFile(front.certificate), agent: false };
    const ask = () => get(front.url + path, options);
    const first = await ask();
    assert.equal((await change("unpublish")).status, 200);
    assert.deepEqual((await ask()).body, first.body, "nginx does not ask the origin");
    const refused = await get(front.purgeUrl + path, { method: "PURGE", localAddress: "127.0.0.2", agent: false });
    assert.equal(refused.status, 403);
    assert.deepEqual((await ask()).body, first.body, "other addresses cannot purge");
    const purged = await fetch(front.purgeUrl + path, { method: "PURGE" });
    assert.equal(purged.status, 404);
    assert.equal((await ask()).status, 404);
    assert.equal((await change("publish")).status, 200);
    let now;
    do now = await ask();
    while (now.status === 404);
    assert.deepEqual(now.body, first.body);
  } finally {
    await front.stop();
    await slow.stop();
  }
});

test("the daemon purges the chunks of a withdrawn model by itself", async () => {
  const slow = await OtherOrigin.start(daemon.port, 86400);
  const front = await Nginx.start([`127.0.0.1:${slow.port}`], [], purgePort);
  try {
    const options = { ca: await readFile(front.certificate), agent: false };
    const ask = () => Promise.all(chunks.map((chunk) => get(`${front.url}/api/v1/chunks/${chunk}`, options)));
    const statuses = async () => new Set((await ask()).map(({ status }) => status));
    assert.deepEqual(await statuses(), new Set([200]));
    assert.equal((await change("unpublish")).status, 200);
    for (let seen = await statuses(); seen.size > 1 || !seen.has(404); seen = await statuses());
    assert.equal((await change("publish")).status, 200);
    for (let seen = await statuses(); seen.size > 1 || !seen.has(200); seen = await statuses());
  } finally {
    await front.stop();
    await slow.stop();
  }
});

test("a copy is confirmed without content once its time is over, and gone after the model is withdrawn", async () => {
  const hasty = await OtherOrigin.start(daemon.port, 1);
  const front = await Nginx.start([`127.0.0.1:${hasty.port}`]);
  try {
    const url = `${front.url}/api/v1/chunks/${chunks.at(-1)}`;
    const options = { ca: await readFile(front.certificate), agent: false };
    const first = await get(url, options);
    assert.equal(first.status, 200);
    while (hasty.confirmed < 2) assert.deepEqual((await get(url, options)).body, first.body);
    assert.equal(hasty.bytes, first.body.length, "the origin has sent the chunk once");

    assert.equal((await change("unpublish")).status, 200);
    let status;
    do ({ status } = await get(url, options));
    while (status === 200);
    assert.equal(status, 404);
    assert.equal((await change("publish")).status, 200);
    let now;
    do now = await get(url, options);
    while (now.status === 404);
    assert.deepEqual(now.body, first.body);
  } finally {
    await front.stop();
    await hasty.stop();
  }
});

test("a withdrawn chunk stays gone while the origin is away, but the cache stores no other response 404", async () => {
  const hasty = await OtherOrigin.start(daemon.port, 1);
  const front = await Nginx.start([`127.0.0.1:${hasty.port}`]);
  try {
    const options = { ca: await readFile(front.certificate), agent: false };
    const ask = (chunk) => get(`${front.url}/api/v1/chunks/${chunk}`, options);
    const withdrawn = chunks.at(-1), unknown = "0".repeat(64);
    assert.equal((await ask(withdrawn)).status, 200);
    assert.equal((await change("unpublish")).status, 200);
    while ((await ask(withdrawn)).status === 200);
    assert.equal((await ask(unknown)).status, 404);
    hasty.fault = 503;
    let answer;
    do answer = await ask(withdrawn);
    while (answer.headers["x-cache"] !== "STALE");
    assert.equal(answer.status, 404);
    assert.equal((await ask(unknown)).status, 503);
    assert.equal((await change("publish")).status, 200);
  } finally {
    await front.stop();
    await hasty.stop();
  }
});

test("a copy whose time is over is served while the origin is overloaded, but not once the origin has found damage", async () => {
  const hasty = await OtherOrigin.start(daemon.port, 1);
  const front = await Nginx.start([`127.0.0.1:${hasty.port}`]);
  try {
    const url = `${front.url}/api/v1/chunks/${chunks.at(-1)}`;
    const options = { ca: await readFile(front.certificate), agent: false };
    assert.equal((await get(url, options)).status, 200);
    hasty.fault = 503;
    let answer;
    do answer = await get(url, options);
    while (answer.headers["x-cache"] !== "STALE");
    assert.equal(answer.status, 200);
    hasty.fault = 500;
    do answer = await get(url, options);
    while (answer.status === 200);
    assert.equal(answer.status, 500);
  } finally {
    await front.stop();
    await hasty.stop();
  }
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
