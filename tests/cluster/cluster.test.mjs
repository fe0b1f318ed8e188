// SPDX-License-Identifier: Apache-2.0
// Tests a cluster on one machine under load. Kills or suspends its parts in turn, then checks the invariants. run.sh
// starts this test.
// Environment: VITRINE_ROUNDS, the number of rounds of faults (default 1); VITRINE_SEED, the seed that chooses victims
// and times, which the test prints.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import { chance } from "../../deploy/capacity/visitors.mjs";
import { Cluster } from "./cluster.mjs";
import { Curator } from "./curator.mjs";
import * as invariants from "./invariants.mjs";
import { relief } from "./meshes.mjs";
import { Passerby } from "./passerby.mjs";
import { Technician } from "./technician.mjs";
import { note, timeline } from "./timeline.mjs";
import { Viewer } from "./viewer.mjs";

const kSides = [220, 200, 180], kBriefSides = [70, 60]; // vertices per side of the meshes
const kViewers = 3;
const kAway = 20_000; // time in ms for which each back end is stopped: first PostgreSQL, later the object store
// Longest time, in ms, without data for a viewer after a serving replica is killed or a back end is stopped. A daemon waits up to
// 5 s for a connection to PostgreSQL before it serves from its cache.
const kLongestGap = 7_000;
const kDeadline = 200_000; // time limit of each step, in ms
const rounds = Number(process.env.VITRINE_ROUNDS ?? 1);
const seed = Number(process.env.VITRINE_SEED ?? Date.now() % 1_000_000);
const random = chance(seed);
const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");
const oneOf = (list) => list[Math.floor(random() * list.length)];

const cluster = new Cluster(process.env.VITRINE_BIN);
let curator, viewers, passerby, technician, expected, work, failure;

/** Defines a test that prints the timeline and all logs if it fails. */
function step(name, body) {
  test(name, async () => {
    note(`== ${name}`);
    const late = new AbortController();
    const deadline = pause(kDeadline, undefined, late).then(() => Promise.reject(new Error("it takes too long")));
    try {
      await Promise.race([body(), failure, deadline]);
    } catch (fault) {
      console.error(`seed ${seed}\n${timeline()}\n${cluster.logs()}`);
      throw fault;
    } finally {
      late.abort();
    }
  });
}

before(async () => {
  console.log(`seed ${seed}`);
  await cluster.start();
  const meshes = [...kSides, ...kBriefSides].map((side, i) => ({ obj: relief(i, side), isBrief: i >= kSides.length }));
  technician = new Technician(cluster.having("serve"), cluster.visitor);
  [expected] = await Promise.all([Promise.all(meshes.map(build)), technician.calibrate()]);
  curator = new Curator(cluster.visitor, meshes);
  passerby = new Passerby(cluster.visitor, random);
  const working = [curator.work(), passerby.stroll(), technician.work()];
  const id = await firstModel();
  const { body: manifest } = await cluster.visitor.json("GET", `/models/${id}/manifest`);
  viewers = Array.from({ length: kViewers }, () => new Viewer(cluster.visitor, id, manifest));
  work = Promise.all([...working, ...viewers.map((viewer) => viewer.watch())]);
  failure = work.then(() => new Promise(() => undefined)); // never resolves, but rejects if a client fails
  failure.catch(() => undefined); // avoids an unhandled rejection between two steps, which await `failure`
});

after(() => cluster.end());

/** Returns the SHA-256 of the file that `vitrine build` makes from a mesh. */
async function build({ obj }, number) {
  const [source, target] = ["obj", "pmesh"].map((kind) => join(cluster.folder, `${number}.${kind}`));
  await writeFile(source, obj);
  await cluster.vitrine("build", source, "--force", "-o", target);
  return sha256(await readFile(target));
}

async function firstModel() {
  for (;; await pause(100)) {
    const order = curator.orders.find(({ model, mesh }) => model && !curator.meshes[mesh].isBrief);
    if (order) return order.model;
  }
}

/** Waits until all jobs requested so far have ended. */
async function jobsEnd() {
  for (const waiting = [...curator.orders]; waiting.some(({ model }) => !model);) await pause(200);
}

/** Asserts that since `from`, no viewer was without data for longer than kLongestGap. */
function assertSeen(from) {
  for (const { progress } of viewers) assert.deepEqual(invariants.lostSessions(progress, from, performance.now(), kLongestGap), []);
}

async function serversDie() {
  const crashes = [() => cluster.nginxCrashes(), ...cluster.having("serve").map((replica) => () => replica.crash())];
  for (const crash of crashes.sort(() => random() - 0.5)) {
    await pause(1_000 * random());
    const from = performance.now();
    await crash();
    await pause(kLongestGap + 1_000);
    assertSeen(from);
  }
}

/**
 * Suspends a replica that runs a job. Resumes the replica after another one has claimed the job.
 * Returns false if the job ended before the replica was suspended.
 */
async function sleepsAtWork() {
  const sleeper = await cluster.builder(), held = `SELECT 1 FROM job WHERE state = 1 AND holder = '${await sleeper.holder()}'`;
  sleeper.signal("SIGSTOP");
  // The job may have ended before the replica was suspended.
  const isAtWork = (await cluster.postgres.query(held)).length > 0;
  while ((await cluster.postgres.query(held)).length > 0) await pause(500);
  sleeper.signal("SIGCONT");
  return isAtWork;
}

async function buildersDieAndSleep() {
  await (await cluster.builder()).crash();
  while (!(await sleepsAtWork()));
  await jobsEnd();
}

/**
 * Kills and suspends daemons during scans. A killed daemon must continue its scan at the same step after its restart. A
 * suspended daemon loses the scanner to another daemon, which restarts the scan.
 */
async function driversDieAndSleep() {
  await technician.turned(1);
  const scan = await technician.scan();
  await technician.measured(scan, 5);
  const sleeper = await cluster.driver();
  await sleeper.crash();
  await technician.measured(scan, 10);
  sleeper.signal("SIGSTOP");
  const hasRestarted = ({ log }) => log.includes(`scan ${scan.id} restarts`);
  while (!cluster.having("scan").some(hasRestarted)) await pause(500);
  sleeper.signal("SIGCONT");
  await technician.scanned(scan);
  const other = await cluster.driver();
  assert.ok(other !== sleeper && hasRestarted(other) && !hasRestarted(sleeper), "which replica restarted the scan");
  await technician.turned(5);
}

/** Stops a back end for a while, and kills a replica during that time. */
async function without(engine) {
  note("a back end is stopped");
  const from = performance.now();
  await engine.ask("kill");
  const dies = random() * kAway, victim = oneOf(cluster.replicas);
  await pause(dies);
  const dying = victim.crash();
  if (engine !== cluster.postgres) await cluster.postgres.ask("kill-backend");
  await pause(kAway - dies);
  await engine.ask("start");
  note("the back end is running again");
  // If a serving replica was killed, viewers may wait for the back end, because the other replicas
  // may lack local copies.
  if (!cluster.having("serve").includes(victim)) assertSeen(from);
  await dying;
  for (const replica of cluster.replicas) await replica.ready();
  await jobsEnd();
}

/** Returns the ids of all models in the list, which comes in pages. */
async function publicModels() {
  const ids = [];
  let cursor = "";
  do {
    const { body } = await cluster.visitor.json("GET", `/models?limit=200${cursor}`);
    ids.push(...body.models.map(({ id }) => id));
    cursor = body.next && `&cursor=${body.next}`;
  } while (cursor);
  return ids;
}

for (let round = 0; round < rounds; ++round) {
  step("nginx and replicas of every role are killed, or suspended beyond their leases: other replicas continue", () =>
    Promise.all([serversDie(), buildersDieAndSleep(), driversDieAndSleep()]));
  step("PostgreSQL is stopped for a while", () => without(cluster.postgres));
  step("the store is stopped for a while, and PostgreSQL loses a process meanwhile", () => without(cluster.gateway));
}

step("all requests have ended", async () => {
  for (const somebody of [curator, passerby, technician, ...viewers]) somebody.stop();
  await work;
  assert.ok(curator.orders.length > 10 && curator.deleted.size > 1, `${curator.orders.length} orders`);
  assert.ok(passerby.looks.length > 10 && technician.turns > 10, `${passerby.looks.length} looks, ${technician.turns} turns`);
  assert.ok(viewers.some(({ resumed }) => resumed > 0), "no viewer has met a replica that died");
});

step("viewers received correct data, and no visitor a partial model", () => {
  for (const viewer of viewers) assert.ok(!viewer.fault && viewer.rounds > 0, `${viewer.rounds} rounds: ${viewer.fault}`);
  assert.deepEqual(invariants.halfVisible(passerby.looks, curator.deleted), []);
});

step("every job has made one model, once", async () => {
  assert.deepEqual(invariants.unfinished([...curator.orders, ...technician.scans]), []);
  assert.deepEqual(invariants.doneTwice((await cluster.postgres.query("SELECT job FROM done")).flat()), []);
  assert.deepEqual(invariants.differentResults(await cluster.postgres.query("SELECT model, file FROM published")), []);
  assert.deepEqual(invariants.unordered(await publicModels(), [...curator.orders, ...technician.scans], curator.deleted), []);
});

step("every model equals the file of vitrine build, bit for bit; no object in use was collected", async () => {
  const named = (await cluster.postgres.query("SELECT DISTINCT encode(file, 'hex') FROM model")).flat();
  assert.deepEqual(invariants.collectedAlive(named, await cluster.gateway.objects()), []);
  const [cold] = cluster.having("serve");
  await cold.crash(); // the daemon's local copies are lost
  const models = [];
  const served = async (model, expected) => {
    const answer = await fetch(`${cold.url}/api/v1/models/${model}/file.pmesh`);
    models.push({ id: model, sha256: answer.ok ? sha256(Buffer.from(await answer.arrayBuffer())) : undefined, expected });
  };
  for (const { model, mesh } of curator.orders.filter(({ model }) => !curator.deleted.has(model))) await served(model, expected[mesh]);
  const scanned = (await cluster.postgres.query("SELECT encode(m.file, 'hex') FROM scan s JOIN model m ON m.id = s.model ORDER BY s.created")).flat();
  for (const [i, { model }] of technician.scans.entries()) await served(model, scanned[i]);
  assert.deepEqual(invariants.otherFiles(models), []);
});

step("the scanner was driven in one epoch at a time", async () => {
  const epochs = (await cluster.postgres.query("SELECT at, holder FROM driven ORDER BY epoch")).map(([at, holder]) => ({ at: Number(at), holder }));
  const commands = [];
  for (const replica of cluster.having("scan")) {
    const holder = await replica.holder();
    commands.push(...(await replica.rig.commands()).map((command) => ({ ...command, holder })));
  }
  const drivers = new Set(epochs.map(({ holder }) => holder)), turns = commands.filter(({ text }) => text.startsWith("G1 X")).length;
  assert.ok(drivers.size === 2 && turns >= technician.turns, `${drivers.size} drivers, ${turns} turns`);
  assert.deepEqual(invariants.outOfEpoch(commands, epochs), []);
});
