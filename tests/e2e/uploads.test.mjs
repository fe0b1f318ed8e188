// SPDX-License-Identifier: Apache-2.0
// Tests uploads with the third-party client tus-js-client. The daemon is killed and restarted
// during an upload. Afterwards, the uploaded file must become a model.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { Daemon } from "./daemon.mjs";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const tus = require("tus-js-client");
const mesh = process.env.VITRINE_MODEL;

let daemon, headers;

before(async () => {
  daemon = await Daemon.start(process.env.VITRINE_BIN);
  const words = ["token", "create", "--role", "operator", "--data", daemon.data, "--json"];
  const { stdout } = await promisify(execFile)(join(daemon.bin, "vitrine"), words);
  headers = { Authorization: `Bearer ${JSON.parse(stdout).token}` };
});
after(() => daemon.stop());

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
