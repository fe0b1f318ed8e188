// SPDX-License-Identifier: Apache-2.0
// Tests uploads with the third-party client tus-js-client, in Node and in pages of other sites. The
// daemon is killed and restarted during an upload. Afterwards, the uploaded file must become a model.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { ViewerPage, launch, newContext } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { writeBlob } from "./models.mjs";
import { StaticHost } from "./static_host.mjs";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const tus = require("tus-js-client");
const mesh = process.env.VITRINE_MODEL;

let daemon, headers, allowed, other;

before(async () => {
  [allowed, other] = await Promise.all([StaticHost.start(), StaticHost.start()]);
  daemon = await Daemon.start(process.env.VITRINE_BIN, ["--allowed-origins", allowed.url]);
  const words = ["token", "create", "--role", "operator", "--data", daemon.data, "--json"];
  const { stdout } = await promisify(execFile)(join(daemon.bin, "vitrine"), words);
  headers = { Authorization: `Bearer ${JSON.parse(stdout).token}` };
});
after(async () => {
  for (const site of [allowed, other]) site?.stop();
  await daemon?.stop();
});

/** Uploads `bytes` and resolves to the upload's ID. Calls `onProgress` with the number of bytes accepted so far. */
function upload(bytes, onProgress = () => undefined) {
  return new Promise((resolve, reject) => {
    const one = new tus.Upload(bytes, {
      endpoint: `${daemon.url}/api/v1/uploads`,
      headers,
      chunkSize: 256 * 1024,
      retryDelays: Array(50).fill(200),
      metadata: { filename: "demosthenes.obj" },
      onChunkComplete: (_, accepted) => onProgress(accepted),
      onSuccess: () => resolve(one.url.split("/").pop()),
      onError: reject,
    });
    one.start();
  });
}

/** Starts a job with the request `order`. Resolves to the job's state when the job has ended. */
async function made(order) {
  const json = { ...headers, "Content-Type": "application/json" };
  const answer = await fetch(`${daemon.url}/api/v1/models`, { method: "POST", headers: json, body: JSON.stringify(order) });
  assert.equal(answer.status, 202);
  const events = await fetch(`${daemon.url}${answer.headers.get("Location")}/events`, { headers });
  const told = (await events.text()).split("\n").filter((line) => line.startsWith("data: "));
  return JSON.parse(told.at(-1).slice("data: ".length));
}

test("an upload resumes where a daemon was killed, and becomes a model", async () => {
  const bytes = await readFile(mesh);
  const accepted = [];
  let restart;
  const id = await upload(bytes, (sent) => {
    accepted.push(sent);
    if (!restart && sent >= bytes.length / 3) restart = daemon.killAndStartAgain();
  });
  assert.ok(restart, "the file is too small to be interrupted");
  await restart;
  for (let i = 1; i < accepted.length; ++i) assert.ok(accepted[i] > accepted[i - 1], "an accepted byte was sent again");
  assert.equal(accepted.at(-1), bytes.length);

  const job = await made({ upload: id, publish: true, metadata: { title: "Demosthenes" } });
  assert.equal(job.state, "done", JSON.stringify(job));
  assert.equal(job.progress, 1);
  const model = await (await fetch(`${daemon.url}/api/v1/models/${job.model}`)).json();
  assert.equal(model.title, "Demosthenes");
  const gone = await fetch(`${daemon.url}/api/v1/uploads/${id}`, { headers });
  assert.equal(gone.status, 404);
});

/** Runs in a page: uploads `text` as a draft, and returns the ID of its model. */
async function draftOf({ api, token, text }) {
  const headers = { Authorization: `Bearer ${token}` };
  const upload = await new Promise((resolve, reject) => {
    const one = new tus.Upload(new Blob([text]), {
      endpoint: `${api}/uploads`, headers, retryDelays: [], onSuccess: () => resolve(one.url.split("/").pop()), onError: reject,
    });
    one.start();
  });
  const order = JSON.stringify({ upload, publish: false, metadata: { title: "Draft" } });
  const answer = await fetch(`${api}/models`, { method: "POST", headers: { ...headers, "Content-Type": "application/json" }, body: order });
  const { job } = await answer.json();
  const events = await (await fetch(`${api}/jobs/${job}/events`, { headers })).text();
  return JSON.parse(events.split("\n").findLast((line) => line.startsWith("data: ")).slice("data: ".length)).model;
}

/** Opens a page of `site`, which has tus-js-client, and uploads a mesh in it. Returns the ID of the model. */
async function draftFrom(browser, site) {
  const file = join(daemon.folder, "blob.ply");
  await writeBlob(file, 20);
  site.add("tus.js", await readFile(require.resolve("tus-js-client/dist/tus.min.js")));
  const page = await (await newContext(browser)).newPage();
  await page.goto(site.add("upload.html", `<!doctype html><link rel="icon" href="data:,"><script src="/tus.js"></script>`));
  const token = headers.Authorization.slice("Bearer ".length);
  return page.evaluate(draftOf, { api: `${daemon.url}/api/v1`, token, text: await readFile(file, "latin1") });
}

test("a page of an allowed site uploads and shows a draft, and another site's page cannot", async () => {
  const browser = await launch();
  try {
    const model = await draftFrom(browser, allowed);
    assert.equal((await fetch(`${daemon.url}/api/v1/models/${model}`)).status, 404, "a draft is public");
    const url = allowed.page({ src: `${daemon.url}/api/v1/models/${model}`, transport: "http" });
    const viewer = await ViewerPage.open(browser, url, { init: `addEventListener("DOMContentLoaded", () => {
      document.querySelector("progressive-mesh").token = ${JSON.stringify(headers.Authorization.slice("Bearer ".length))};
    })` });
    await viewer.events("load");
    const { faces } = await (await fetch(`${daemon.url}/api/v1/models/${model}`, { headers })).json();
    assert.equal(await viewer.triangles(), faces);
    await assert.rejects(draftFrom(browser, other), /failed to upload|tus/i);
  } finally {
    await browser.close();
  }
});
