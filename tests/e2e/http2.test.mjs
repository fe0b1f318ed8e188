// SPDX-License-Identifier: Apache-2.0
// Tests the daemon behind nginx with the shipped configuration over HTTP/2, as browsers use it. Mutated frames of HTTP/2
// must do no harm.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_FRAMES (number of mutated connections, default 400),
// VITRINE_SEED.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { createHash } from "node:crypto";
import { once } from "node:events";
import { readFile, readdir } from "node:fs/promises";
import http2 from "node:http2";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { connect } from "node:tls";
import { promisify } from "node:util";
import { chance } from "../../deploy/capacity/visitors.mjs";
import { Daemon, env } from "./daemon.mjs";
import { Nginx } from "./nginx.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan } = process.env;
const seed = Number(process.env.VITRINE_SEED ?? Date.now() % 1_000_000), random = chance(seed);
const kMutated = Number(process.env.VITRINE_FRAMES ?? 400);
const kKept = 64; // largest number of idle connections to the daemon that nginx keeps open
const kAtOnce = 8; // number of mutated connections that are open at the same time
const below = (count) => Math.floor(random() * count);
let daemon, nginx, session, id, chunks, ca, token;

before(async () => {
  daemon = await Daemon.start(bin, ["--trusted-proxies", "127.0.0.1", "--request-rate", "0"]);
  id = (await daemon.publish(scan, "Demosthenes")).split("/").pop();
  nginx = await Nginx.start([`127.0.0.1:${daemon.port}`]);
  ca = await readFile(nginx.certificate);
  session = http2.connect(nginx.url, { ca });
  const { stdout } = await promisify(execFile)(join(bin, "vitrine"), ["token", "create", "--role", "operator", "--data", daemon.data, "--json"], { env });
  ({ token } = JSON.parse(stdout));
  chunks = JSON.parse((await ask(`/api/v1/models/${id}/manifest`)).body).chunks.map(({ sha256 }) => sha256);
});

after(async () => {
  session?.close();
  await nginx?.stop();
  await daemon?.stop();
});

/**
 * Sends a request on the HTTP/2 connection, which may have other requests in progress. Returns the whole response. nginx ends
 * a connection after 1,000 requests (keepalive_requests). The next request then opens a new connection.
 */
async function ask(path, fields = {}) {
  if (session.closed) session = http2.connect(nginx.url, { ca });
  const stream = session.request({ ":path": path, ...fields });
  stream.end();
  const [headers] = await once(stream, "response");
  return { status: headers[":status"], headers, body: Buffer.concat(await stream.toArray()) };
}

/** Publishes or unpublishes the model. `verb` is "publish" or "unpublish". */
async function change(verb) {
  assert.equal((await ask(`/api/v1/models/${id}/${verb}`, { ":method": "POST", authorization: `Bearer ${token}` })).status, 200);
}

test("all chunks come over one connection at once, whole and from the cache the second time", async () => {
  assert.equal(session.alpnProtocol, "h2");
  for (const cached of [false, true]) {
    const answers = await Promise.all(chunks.map((sha256) => ask(`/api/v1/chunks/${sha256}`)));
    for (const [i, { status, headers, body }] of answers.entries()) {
      assert.equal(status, 200);
      assert.equal(createHash("sha256").update(body).digest("hex"), chunks[i]);
      assert.match(headers["cache-control"], /immutable/);
      if (cached) assert.equal(headers["x-cache"], "HIT");
    }
  }
});

test("ranges and conditions are answered", async () => {
  const path = `/api/v1/chunks/${chunks.at(-1)}`, whole = await ask(path);
  const part = await ask(path, { range: "bytes=10-19" });
  assert.equal(part.status, 206);
  assert.deepEqual(part.body, whole.body.subarray(10, 20));
  assert.equal((await ask(path, { "if-none-match": whole.headers.etag })).status, 304);
  const manifest = `/api/v1/models/${id}/manifest`, { headers } = await ask(manifest);
  assert.equal((await ask(manifest, { "if-none-match": headers.etag })).status, 304);
  assert.equal((await ask(manifest, { "if-none-match": '"another"' })).status, 200);
});

test("a withdrawn model's chunk is gone once purged, and comes back once it is public again", async () => {
  const path = `/api/v1/chunks/${chunks.at(-1)}`, first = await ask(path);
  assert.equal(first.status, 200);
  await change("unpublish");
  assert.equal((await ask(`/api/v1/models/${id}/manifest`)).status, 404);
  assert.equal((await fetch(nginx.purgeUrl + path, { method: "PURGE" })).status, 404);
  assert.equal((await ask(path)).status, 404);
  await change("publish");
  let now;
  do now = await ask(path);
  while (now.status === 404);
  assert.deepEqual(now.body, first.body);
});

/** Returns an HTTP/2 frame ([RFC9113] section 4.1). */
function frame(type, flags, stream, payload = Buffer.alloc(0)) {
  const head = Buffer.alloc(9);
  head.writeUIntBE(payload.length, 0, 3);
  head[3] = type;
  head[4] = flags;
  head.writeUInt32BE(stream, 5);
  return Buffer.concat([head, payload]);
}

const text = (words) => Buffer.concat([Buffer.from([words.length]), Buffer.from(words)]);

/** Returns the header fields of a request, coded by HPACK [RFC7541] without Huffman codes. */
function fields(method, path, more = {}) {
  const literals = Object.entries(more).map(([name, value]) => Buffer.concat([Buffer.from([0]), text(name), text(value)]));
  return Buffer.concat([Buffer.from([method === "GET" ? 0x82 : 0x83, 0x87, 0x01]), text("localhost"), Buffer.from([0x04]), text(path), ...literals]);
}

/**
 * Returns the frames of a valid connection: requests with and without a body, a reset stream, and
 * the control frames SETTINGS, WINDOW_UPDATE, PING, PRIORITY and GOAWAY.
 */
function valid() {
  const upload = { authorization: `Bearer ${token}`, "tus-resumable": "1.0.0", "upload-length": "8" };
  const order = { authorization: `Bearer ${token}`, "content-type": "application/json" };
  return [Buffer.from("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"), frame(4, 0, 0, Buffer.from([0, 3, 0, 0, 0, 100, 0, 4, 0, 1, 0, 0])),
    frame(1, 5, 1, fields("GET", `/api/v1/chunks/${chunks[0]}`)), frame(8, 0, 0, Buffer.from([0, 1, 0, 0])),
    frame(1, 5, 3, fields("GET", `/api/v1/models/${id}/manifest`, { "if-none-match": '"x"' })), frame(6, 0, 0, Buffer.alloc(8)),
    frame(1, 4, 5, fields("POST", "/api/v1/models", order)), frame(0, 1, 5, Buffer.from('{"upload": "none"}')),
    frame(1, 5, 7, fields("GET", `/api/v1/models/${id}/file.pmesh`)), frame(3, 0, 7, Buffer.from([0, 0, 0, 8])),
    frame(1, 5, 9, fields("POST", "/api/v1/uploads", upload)), frame(2, 0, 9, Buffer.from([0, 0, 0, 1, 16])),
    frame(1, 1, 11, fields("GET", "/api/v1/models")), frame(9, 4, 11, Buffer.from([0, 1, 97, 1, 98])), frame(7, 0, 0, Buffer.alloc(8))];
}

/**
 * Returns the bytes of the frames after random changes. Frames may be removed, repeated, reversed
 * or inserted. Bytes may be replaced or cut off.
 */
function mutated(frames) {
  const changed = [...frames], at = 1 + below(frames.length - 1);
  const kinds = [() => changed.splice(at, 1), () => changed.splice(at, 0, ...Array(1 + below(30)).fill(changed[at])), () => changed.reverse(),
    () => changed.splice(at, 0, frame(below(12), below(256), below(14), Buffer.alloc(below(64), below(256)))), () => undefined, () => undefined];
  kinds[below(kinds.length)]();
  const bytes = Buffer.concat(changed);
  for (let count = below(6); count > 0; --count) bytes[24 + below(bytes.length - 24)] = below(256);
  return bytes.subarray(0, random() < 0.2 ? below(bytes.length) : bytes.length);
}

/** Sends the bytes on a new connection, and waits until nginx has closed the connection. */
async function send(bytes) {
  const socket = connect({ port: nginx.port, host: "127.0.0.1", servername: "localhost", ca, ALPNProtocols: ["h2"] });
  socket.on("error", () => undefined).resume().end(bytes);
  await new Promise((resolve) => socket.once("close", resolve));
}

const descriptors = async () => (await readdir(`/proc/${daemon.child.pid}/fd`)).length;

test(`${kMutated} connections of mutated frames do no harm (seed ${seed})`, async () => {
  const frames = valid();
  await send(Buffer.concat(frames));
  const before = await descriptors();
  for (let sent = 0; sent < kMutated; sent += kAtOnce) await Promise.all(Array.from({ length: kAtOnce }, () => send(mutated(frames))));
  const path = `/api/v1/chunks/${chunks[0]}`;
  const { status, body } = await ask(path);
  assert.equal(status, 200);
  assert.equal(createHash("sha256").update(body).digest("hex"), chunks[0]);
  const failed = (await daemon.metrics()).filter(([name, labels, value]) => name === "vitrine_http_requests_total" && value > 0 && labels.includes('status="5xx"'));
  assert.deepEqual(failed, []);
  while ((await descriptors()) > before + kKept);
});
