// SPDX-License-Identifier: Apache-2.0
// Two daemons share a PostgreSQL catalogue and a Ceph bucket, and build models. The clock of one daemon is ten minutes fast, then
// ten minutes slow: more than a lease lasts, and less than the gateway allows for a signed request. No daemon may claim a job that
// the other one is working on. run.sh starts this test.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdir, mkdtemp, open, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { env } from "../e2e/daemon.mjs";
import { freePort } from "../e2e/nginx.mjs";
import { Gateway, Postgres, sharedSettings } from "./backends.mjs";
import * as invariants from "./invariants.mjs";
import { relief } from "./meshes.mjs";
import { Replica } from "./replica.mjs";

const bin = process.env.VITRINE_BIN, run = promisify(execFile);
const kSkew = 600; // seconds by which one daemon's clock is fast or slow
const kSide = 150; // vertices per side of the meshes
const kMostPairs = 10; // after at most this many pairs of jobs, each daemon must have claimed a job
const kHistory = `
  CREATE TABLE claimed(job BYTEA, holder TEXT);
  CREATE FUNCTION claimed() RETURNS trigger LANGUAGE plpgsql AS 'BEGIN INSERT INTO claimed VALUES (NEW.id, NEW.holder); RETURN NULL; END';
  CREATE TRIGGER claimed AFTER UPDATE OF attempts ON job FOR EACH ROW WHEN (NEW.attempts > OLD.attempts) EXECUTE FUNCTION claimed();`;
const postgres = new Postgres(), gateway = new Gateway();
let folder, token, offset, replicas, orders = 0;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vitrine-clock-"));
  await Promise.all([postgres.start(), gateway.start(), mkdir(join(folder, "uploads"))]);
  const conf = join(folder, "vitrine.conf"), library = join(folder, "clock.so"), file = join(folder, "offset");
  await writeFile(conf, sharedSettings(folder, postgres, gateway));
  await run("cc", ["-O1", "-shared", "-fPIC", "-o", library, fileURLToPath(new URL("../crash/clock.c", import.meta.url))]);
  await writeFile(file, Buffer.alloc(8));
  offset = await open(file, "r+");
  const { stdout } = await run(join(bin, "vitrine"), ["token", "create", "--role", "operator", "--data", conf, "--json"], { env });
  ({ token } = JSON.parse(stdout));
  await postgres.query(kHistory);
  replicas = await Promise.all([replica("right", conf), replica("wrong", conf, { LD_PRELOAD: library, CLOCK_OFFSET: file })]);
  await Promise.all(replicas.map((one) => one.ready()));
});

after(async () => {
  await Promise.all(replicas.map((one) => one.end()));
  await Promise.all([postgres.end(), gateway.end(), offset.close()]);
  await rm(folder, { recursive: true, force: true });
});

async function replica(name, conf, variables) {
  await mkdir(join(folder, name));
  return new Replica(name, bin, join(folder, name), await freePort(), ["--config", conf, "--roles", "serve,build"], variables);
}

async function jump(seconds) {
  const bytes = Buffer.alloc(8);
  bytes.writeBigInt64LE(BigInt(seconds));
  await offset.write(bytes, 0, 8, 0);
}

async function ask({ url }, method, path, body, headers = {}) {
  const answer = await fetch(url + path, { method, headers: { Authorization: `Bearer ${token}`, ...headers }, body });
  assert.ok(answer.ok, `${method} ${path}: ${answer.status}`);
  return answer;
}

/** Starts a job through a daemon. Returns the job's ID. */
async function order(one) {
  const mesh = relief(orders++, kSide), tus = { "Tus-Resumable": "1.0.0" };
  const path = (await ask(one, "POST", "/api/v1/uploads", undefined, { ...tus, "Upload-Length": `${mesh.length}` })).headers.get("location");
  await ask(one, "PATCH", path, mesh, { ...tus, "Upload-Offset": "0", "Content-Type": "application/offset+octet-stream" });
  const body = JSON.stringify({ upload: path.split("/").pop(), publish: true });
  return (await (await ask(one, "POST", "/api/v1/models", body, { "Content-Type": "application/json" })).json()).job;
}

async function ended(job) {
  for (;; await pause(50)) {
    const { state, error } = await (await ask(replicas[0], "GET", `/api/v1/jobs/${job}`)).json();
    assert.ok(state !== "failed", error);
    if (state === "done") return;
  }
}

for (const [name, skew] of [["fast", kSkew], ["slow", -kSkew]]) {
  test(`no daemon claims another's job while one clock is ${name}`, async () => {
    await postgres.query("DELETE FROM claimed");
    await jump(skew);
    const wrong = await replicas[1].holder(), holders = new Set();
    for (let pairs = 0; holders.size < 2; ++pairs) {
      assert.ok(pairs < kMostPairs, "one daemon claims all jobs");
      await Promise.all((await Promise.all(replicas.map(order))).map(ended));
      for (const [holder] of await postgres.query("SELECT holder FROM claimed")) holders.add(holder);
    }
    assert.ok(holders.has(wrong));
    const claims = (await postgres.query("SELECT job FROM claimed")).flat();
    assert.deepEqual(invariants.doneTwice(claims), [], "jobs that were claimed twice");
    const [[furthest]] = await postgres.query(`SELECT max((created / 1000 - extract(epoch FROM now())) * ${Math.sign(skew)}) FROM job`);
    assert.ok(Number(furthest) > kSkew / 2, "no clock was wrong, so this test proves nothing");
  });
}
