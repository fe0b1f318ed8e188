// SPDX-License-Identifier: Apache-2.0
// Requests every route of the OpenAPI document as every role, for models in every state, on two
// daemons that share a PostgreSQL catalogue and a Ceph bucket. One daemon, which drives a simulated
// scanner, makes and changes the model. Neither daemon may then reveal a hidden part of the model,
// and both must respond with the same statuses. Prints the access matrix. run.sh starts this test.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { randomBytes } from "node:crypto";
import { once } from "node:events";
import { mkdir, mkdtemp, rm, writeFile } from "node:fs/promises";
import http from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import { promisify } from "node:util";
import { firstRig } from "./rigs.mjs";
import { env } from "../e2e/daemon.mjs";
import { freePort } from "../e2e/nginx.mjs";
import { Gateway, Postgres, sharedSettings } from "./backends.mjs";
import { relief } from "./meshes.mjs";
import { Replica } from "./replica.mjs";
import { Secrets } from "./secrets.mjs";

const bin = process.env.VITRINE_BIN;
// Formats whose bytes are compared with secrets. The other formats are requested in the first state only: they store numbers as
// text, and the public manifest may contain the same text.
const kBinary = ["glb", "ply", "stl", "drc"];
const kFormats = [...kBinary, "obj", "wrl", "3mf", "usdz", "obj.zip"];
const kRoles = ["none", "viewer", "operator", "admin"];
const kPages = ["/", "/models/{id}", "/collections/{collection}", "/scans/{id}", "/sitemap.xml", "/docs", "/console"];
const kForm = { "Content-Type": "application/x-www-form-urlencoded" };
const kCollection = "Hidden cabinet"; // the collection of all models
const kSide = 30; // vertices per side of the mesh
const kSteps = 8; // number of turntable steps per scan
const kLongSteps = 2000; // number of turntable steps of a scan that is cancelled
const kPoses = 12; // number of target poses of the calibration
const postgres = new Postgres(), gateway = new Gateway();
const matrix = new Map();
let folder, replicas, tokens, routes, states = 0;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vitrine-access-"));
  await Promise.all([postgres.start(), gateway.start(), mkdir(join(folder, "uploads"))]);
  const conf = join(folder, "vitrine.conf");
  await writeFile(conf, sharedSettings(folder, postgres, gateway));
  tokens = { none: undefined };
  for (const role of kRoles.slice(1)) tokens[role] = await token(role, conf);
  replicas = await Promise.all([replica("first", conf, firstRig), replica("second", conf)]);
  await Promise.all(replicas.map((one) => one.ready()));
  routes = await routesOf(replicas[0]);
  while ((await ask(replicas[0], "GET", "/api/v1/scanners/rig", "operator")).status !== 200) await pause(100);
  const { job } = await json(replicas[0], "POST", "/scanners/rig/calibrations", "operator", { poses: kPoses });
  await ended(job);
});

after(async () => {
  await Promise.all(replicas.map((one) => one.end()));
  await Promise.all([postgres.end(), gateway.end()]);
  await rm(folder, { recursive: true, force: true });
});

async function token(role, conf) {
  const { stdout } = await promisify(execFile)(join(bin, "vitrine"), ["token", "create", "--role", role, "--data", conf, "--json"], { env });
  return JSON.parse(stdout).token;
}

/** Starts a daemon. The daemon drives the scanner `rig`, if one is given. */
async function replica(name, conf, rig) {
  await mkdir(join(folder, name));
  const port = await freePort(), words = ["--config", conf, "--roles", rig ? "serve,build,scan" : "serve,build"];
  if (rig) words.push("--scanners", rig.config, "--scan-address", `http://127.0.0.1:${port}`);
  return new Replica(name, bin, join(folder, name), port, words, rig?.env);
}

/** Returns all routes as {method, path, role}. */
async function routesOf(one) {
  const { paths } = JSON.parse((await ask(one, "GET", "/api/v1/openapi.json")).body);
  const documented = Object.entries(paths).flatMap(([path, calls]) => Object.entries(calls).map(([method, call]) =>
    ({ method: method.toUpperCase(), path, role: call["x-role"] ?? "none" })));
  return [...documented.filter(({ method, path }) => method !== "OPTIONS" && !path.endsWith("/stream")),
          ...kPages.map((path) => ({ method: "GET", path, role: "none" }))];
}

/** Sends a request and returns the whole response. */
async function ask({ port }, method, path, role = "none", body, more = {}) {
  const headers = { ...(tokens[role] && { Authorization: `Bearer ${tokens[role]}` }), ...(body && { "Content-Type": "application/json" }), ...more };
  const request = http.request({ host: "127.0.0.1", port, method, path, headers, agent: false });
  request.end(body);
  const [response] = await once(request, "response");
  return { status: response.statusCode, headers: response.headers, body: Buffer.concat(await response.toArray()) };
}

/** Returns the first event of a stream of events, or the whole response if it is not such a stream. */
async function firstEvent({ port }, path, role) {
  const headers = tokens[role] && { Authorization: `Bearer ${tokens[role]}` };
  const request = http.get({ host: "127.0.0.1", port, path, headers, agent: false });
  const [response] = await once(request, "response"), parts = [];
  const isStream = response.headers["content-type"] === "text/event-stream";
  for await (const part of response) if (parts.push(part) && isStream && Buffer.concat(parts).includes("\n\n")) break;
  request.destroy();
  return { status: response.statusCode, headers: response.headers, body: Buffer.concat(parts) };
}

async function json(one, method, path, role, value) {
  const { status, body } = await ask(one, method, `/api/v1${path}`, role, value && JSON.stringify(value));
  assert.ok(status < 300, `${method} ${path}: ${status} ${body}`);
  return body.length > 0 ? JSON.parse(body) : undefined;
}

/** Waits for the end of a job. Returns the ID of its model. */
async function ended(job) {
  await ask(replicas[0], "GET", `/api/v1/jobs/${job}/events`, "operator"); // the response ends when the job ends
  const { state, model, error } = await json(replicas[0], "GET", `/jobs/${job}`, "operator");
  assert.equal(state, "done", error);
  return model;
}

/** Makes a model from a mesh, which is uploaded to the first daemon. Returns {model, job}. */
async function upload(number, order) {
  const mesh = relief(number, kSide), tus = { "Tus-Resumable": "1.0.0" };
  const { headers } = await ask(replicas[0], "POST", "/api/v1/uploads", "operator", undefined, { ...tus, "Upload-Length": mesh.length });
  const sent = { ...tus, "Upload-Offset": 0, "Content-Type": "application/offset+octet-stream", "Content-Length": mesh.length };
  assert.equal((await ask(replicas[0], "PATCH", headers.location, "operator", mesh, sent)).status, 204);
  const { job } = await json(replicas[0], "POST", "/models", "operator", { upload: headers.location.split("/").pop(), metadata: { title: "Relief", collection: kCollection }, ...order });
  return { model: await ended(job), job };
}

const startScan = (steps, order) => json(replicas[0], "POST", "/scans", "operator", { scanner: "rig", steps, metadata: { title: "Scan", collection: kCollection }, ...order });

/** Makes a model by a scan. Returns {model, job, scan}. */
async function scan(number, order) {
  const { id, job } = await startScan(kSteps, order);
  return { model: await ended(job), job, scan: id };
}

/** Starts a scan and waits until it has measured points. Returns {model, job, scan}; `model` does not exist. */
async function begunScan(order) {
  const { id, job } = await startScan(kLongSteps, order);
  const points = () => ask(replicas[0], "GET", `/api/v1/scans/${id}/points`, "operator");
  for (let { status, body } = await points(); status !== 200 || body.length < 1000; { status, body } = await points()) await pause(50);
  return { model: "01arz3ndektsv4rrffq69g5fb0", job, scan: id };
}

async function cancelScan({ job }) {
  await json(replicas[0], "DELETE", `/jobs/${job}`, "operator");
  while ((await json(replicas[0], "GET", `/jobs/${job}`, "operator")).state !== "cancelled") await pause(50);
}

const manifestOf = (one, model, role) => ask(one, "GET", `/api/v1/models/${model}/manifest`, role);

/**
 * Returns bytes that reveal a model at `level`, or at its finest level if `level` is undefined: its
 * exports and, at the finest level, also its chunks. Adds the poster if `hasPoster`. A model with
 * capped levels has a public poster, which may share bytes with that of the finest level.
 */
async function pictured(model, level, hasPoster = false) {
  const query = level === undefined ? "" : `?level=${level}`, paths = kBinary.map((format) => `/export.${format}${query}`);
  const chunks = level === undefined ? JSON.parse((await manifestOf(replicas[0], model, "admin")).body).chunks : [];
  if (hasPoster) paths.push("/poster.png?width=240");
  if (level === undefined) paths.push(...chunks.map(({ sha256 }) => `/chunks/${sha256}`));
  const answers = await Promise.all(paths.map((path) => ask(replicas[0], "GET", `/api/v1/models/${model}${path}`, "admin")));
  answers.forEach(({ status }, i) => assert.equal(status, 200, paths[i]));
  return { bytes: answers.map(({ body }) => withoutText(body)), names: chunks.map(({ sha256 }) => sha256) };
}

/**
 * Returns the points and the profile of a model's scan, or an empty list if the model was not
 * scanned.
 */
async function measuredBy({ scan }) {
  const paths = scan ? [`/scans/${scan}/points`, `/scans/${scan}/profile`] : [];
  const answers = await Promise.all(paths.map((path) => ask(replicas[0], "GET", `/api/v1${path}`, "admin")));
  answers.forEach(({ status, body }, i) => assert.ok(status === 200 && body.length > 16, paths[i]));
  return { bytes: answers.map(({ body }) => body) };
}

/** Gives a model a note and a tour. Returns their texts, of which each has 64 bytes. */
async function annotate({ model }) {
  const [note, tour] = [0, 1].map(() => randomBytes(32).toString("hex"));
  await json(replicas[0], "PUT", `/models/${model}/notes`, "operator", { notes: [{ id: "a", position: [0, 0, 0], texts: { en: { title: "A", text: note } } }] });
  await json(replicas[0], "PUT", `/models/${model}/tours`, "operator", { tours: [{ id: "t", titles: { en: tour }, steps: [{ note: "a" }] }] });
  return { bytes: [note, tour].map((text) => Buffer.from(text)) };
}

/** Returns the file. For a GLB, removes its JSON, because the words in the JSON are not secret. */
function withoutText(file) {
  return file.subarray(0, 4).toString() === "glTF" ? file.subarray(20 + file.readUInt32LE(12)) : file;
}

/**
 * Waits until the second daemon shows visitors the same model as the first daemon. This can take a
 * second.
 */
async function agree(model) {
  const seen = ({ status, headers }) => `${status} ${status === 200 ? headers.etag : ""}`;
  for (;;) {
    const [first, second] = await Promise.all(replicas.map((one) => manifestOf(one, model, "none")));
    if (seen(first) === seen(second)) return first.status;
  }
}

/** Returns all paths of a route. Each parameter is replaced by each of its `values`. */
function expanded(path, values) {
  const name = path.match(/\{(\w+)\}/)?.[1];
  if (!name) return [path];
  assert.ok(values[name], `${path}: add the new parameter to this test`);
  return values[name].flatMap((value) => expanded(path.replace(`{${name}}`, value), values));
}

function queries(path, model) {
  if (path.endsWith("/export.glb")) return ["", "?level=highest", "?lod=msft"];
  if (path.includes("/export.")) return ["", "?level=highest"];
  if (path.endsWith("/manifest")) return ["", "?level=highest"];
  if (path.endsWith("/poster.png")) return ["?width=240"];
  if (/^\/api\/v1\/(models|facets)$/.test(path)) return ["", "?drafts=true"];
  if (path === "/api/v1/oai")
    return ["?verb=ListRecords&metadataPrefix=lido", `?verb=GetRecord&metadataPrefix=edm&identifier=oai:127.0.0.1:${model}`];
  return path.endsWith("/oembed") ? [`?url=http://localhost/models/${model}`] : [""];
}

/** Sends a request. For a POST request to OAI-PMH, sends the query in the body. */
function answered(one, method, path, query, role) {
  if (path === "/api/v1/oai" && method === "POST") return ask(one, method, path, role, query.slice(1), kForm);
  return path.endsWith("/events") ? firstEvent(one, path + query, role) : ask(one, method, path + query, role);
}

/**
 * Requests a route from one daemon as one role, for all values of the route's parameters. Returns the
 * statuses.
 */
async function walk(one, { method, path, role: least }, role, { state, made, names, secrets }) {
  const may = kRoles.indexOf(role) >= kRoles.indexOf(least), statuses = [];
  if (may && method !== "GET" && path !== "/api/v1/oai") return statuses; // the request would change the model
  const ids = [made.model, made.job, "01arz3ndektsv4rrffq69g5fav", ...(made.scan ? [made.scan] : []), ...(made.others ?? [])];
  const values = { id: ids, sha256: names, format: states === 1 ? kFormats : kBinary, name: ["rig"], number: ["1"], collection: [encodeURIComponent(kCollection)] };
  for (const expansion of expanded(path, values)) {
    for (const query of queries(expansion, made.model)) {
      const { status, body } = await answered(one, method, expansion, query, role), request = `${state}: ${role} ${method} ${expansion}${query}`;
      assert.ok(status < 500, `${request}: ${status} ${body}`);
      assert.ok(may ? role === "none" || status !== 403 : status === (role === "none" ? 401 : 403), `${request}: ${status}`);
      assert.ok(role !== "none" || !secrets.areIn(body), `${request} gives what is hidden`);
      statuses.push(status);
    }
  }
  return statuses;
}

/**
 * Returns the bytes that a visitor receives over a model's stream, with its head and all levels.
 */
async function streamed({ port }, model) {
  const headers = { Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Protocol": "pmesh.v1",
                    "Sec-WebSocket-Key": randomBytes(16).toString("base64") };
  const request = http.get({ host: "127.0.0.1", port, path: `/api/v1/models/${model}/stream?head=true`, headers });
  const socket = await new Promise((resolve) => request.once("upgrade", (_, opened) => resolve(opened)).once("response", () => resolve(undefined)));
  if (!socket) return Buffer.alloc(0);
  for (const message of [{ type: "ack", bytes: 16777216 }, { type: "want", level: 255 }]) {
    const text = Buffer.from(JSON.stringify(message));
    socket.write(Buffer.concat([Buffer.from([0x81, 0x80 | text.length, 0, 0, 0, 0]), text]));
  }
  const parts = [];
  for await (const part of socket) if (parts.push(part) && Buffer.concat(parts.slice(-2)).includes('"done"')) break;
  return Buffer.concat(parts);
}

const change = (path, value) => ({ model }) => json(replicas[0], value ? "PATCH" : "POST", `/models/${model}${path}`, "operator", value);
const cap = change("", { public_max_level: 0 });
/** Makes another model, which is not public, from the scan. Stores its ID in `made.others`. */
const reprocess = async (made) => {
  const { job } = await json(replicas[0], "POST", `/scans/${made.scan}/reprocess`, "operator", { bits: 14 });
  made.others = [await ended(job)];
};
const replace = async ({ model }) => upload(100 + states, { replace: model });

// Each state has a name, the order that makes the model, and the change that leads to the state. The last two values are
// the status for visitors, and the part of the model that is then public: all, level 0, or nothing. A scan's points and
// profiles are public only if its whole model is public.
const kStates = [
  ["published", { publish: true }, () => undefined, 200, "all"],
  ["in cm", { publish: true }, change("", { unit: "cm" }), 200, "all"],
  ["capped at its finest level", { publish: true }, change("", { public_max_level: 255 }), 200, "all"],
  ["capped", { publish: true }, cap, 200, 0],
  ["replaced", { publish: true }, replace, 200, "all"],
  ["capped, replaced", { publish: true }, async (made) => {
    await cap(made);
    await replace(made);
  }, 200, 0],
  ["withdrawn", { publish: true }, change("/unpublish"), 404, "none"],
  ["published again", { publish: true }, async (made) => {
    await change("/unpublish")(made);
    await change("/publish")(made);
  }, 200, "all"],
  ["a draft", { publish: false }, () => undefined, 404, "none"],
  ["removed", { publish: true }, ({ model }) => json(replicas[0], "DELETE", `/models/${model}`, "operator"), 404, "none"],
];

// States that only a scan's model can have.
const kOfScans = [
  ["capped, reprocessed", { publish: true }, async (made) => {
    await cap(made);
    await reprocess(made);
  }, 200, 0],
  ["withdrawn, reprocessed", { publish: true }, async (made) => {
    await change("/unpublish")(made);
    await reprocess(made);
  }, 404, "none"],
];

const kOpen = ["published", "in cm", "published again", "capped at its finest level"]; // states in which nothing is hidden

for (const [make, [state, order, enter, status, shown]] of [...kStates.map((row) => [upload, row]), ...[...kStates, ...kOfScans].map((row) => [scan, row])]) {
  const subject = make === scan ? "the scan's model" : "the model";
  test(`${subject} gives nothing that it hides if it is ${state}`, async () => {
    const made = await make(++states, order), secrets = new Secrets();
    const noted = await annotate(made);
    await agree(made.model);
    const hidesPoster = typeof shown !== "number";
    const old = await pictured(made.model, undefined, hidesPoster);
    await Promise.all(replicas.map((one) => streamed(one, made.model))); // now both daemons have the model in memory
    const measured = await measuredBy(made);
    await enter(made);
    assert.equal(await agree(made.model), status);
    const now = state === "removed" ? old : await pictured(made.model, undefined, hidesPoster);
    const others = await Promise.all((made.others ?? []).map((model) => pictured(model, undefined, hidesPoster)));
    for (const { bytes } of [old, now, measured, ...others]) bytes.forEach((part) => secrets.hide(part));
    // Visitors may see the notes of a model if they may see the model, also if its levels are capped.
    if (status === 404) noted.bytes.forEach((part) => secrets.hide(part));
    else assert.ok((await ask(replicas[0], "GET", `/api/v1/models/${made.model}/notes`)).body.includes(noted.bytes[0]));
    const open = shown === "all" ? now : shown === "none" ? { bytes: [] } : await pictured(made.model, shown);
    open.bytes.forEach((part) => secrets.reveal(part));
    // Every export states the model's URL as its source. The URL of a public model made at the same time begins with the same
    // characters, because the first ten characters of an ID encode the time.
    secrets.reveal(Buffer.from(`http://127.0.0.1:${replicas[0].port}/models/${made.model.slice(0, 10)}`));
    secrets.reveal(Buffer.from('<?xml version="1.0" encoding="UTF-8"?>\n<')); // records and 3MF files begin with this text
    if (kOpen.includes(state)) measured.bytes.forEach((part) => secrets.reveal(part));
    assert.ok(kOpen.includes(state) || secrets.size > 100, "nothing is hidden, so this test proves nothing");
    const visit = { state: `${subject} is ${state}`, made, secrets, names: [...new Set([old, now, ...others].flatMap(({ names }) => names))] };
    for (const route of routes) await walkAll(route, visit);
    for (const one of replicas) assert.ok(!secrets.areIn(await streamed(one, made.model)), "the stream gives what is hidden");
    // Scans of the same object can have a chunk in common, which would then be public in later states.
    if (made.scan && state !== "removed") await json(replicas[0], "DELETE", `/models/${made.model}`, "operator");
  });
}

for (const [state, publish, enter, status] of [["being scanned as public", true, () => undefined, 200],
                                              ["being scanned as a draft", false, () => undefined, 401],
                                              ["cancelled", true, cancelScan, 401]]) {
  test(`a scan gives nothing that it hides if it is ${state}`, async () => {
    const made = await begunScan({ publish }), secrets = new Secrets();
    ++states;
    try {
      await enter(made);
      const { bytes } = await measuredBy(made);
      if (status !== 200) bytes.forEach((part) => secrets.hide(part));
      for (const route of routes) await walkAll(route, { state: `the scan is ${state}`, made, secrets, names: [] });
      for (const one of replicas) assert.equal((await ask(one, "GET", `/api/v1/scans/${made.scan}/points`)).status, status);
    } finally {
      if (enter !== cancelScan) await cancelScan(made);
    }
  });
}

async function walkAll(route, visit) {
  for (const role of states === 1 ? kRoles : ["none"]) { // the model's state changes only what visitors see
    const [first, second] = await Promise.all(replicas.map((one) => walk(one, route, role, visit)));
    assert.deepEqual(second, first, `${visit.state}: ${role} ${route.method} ${route.path}`);
    const row = `${route.method} ${route.path}`, column = role === "none" ? `visitor; ${visit.state}` : role;
    if (!matrix.has(row)) matrix.set(row, new Map());
    if (first.length > 0) matrix.get(row).set(column, Math.min(...first, matrix.get(row).get(column) ?? 999));
  }
}

test("the access matrix", () => {
  const columns = [...new Set([...matrix.values()].flatMap((row) => [...row.keys()]))].sort();
  columns.forEach((name, i) => console.log(`[${i + 1}] ${name}`));
  for (const [route, row] of matrix) console.log(route.padEnd(66) + columns.map((name) => String(row.get(name) ?? "").padStart(5)).join(""));
  assert.ok(matrix.size >= 40);
});
