// SPDX-License-Identifier: Apache-2.0
// A cluster on one machine, under load, whose parts die, sleep and go away one after the other; and what
// has to hold of it afterwards. By run.sh. Environment: VITRINE_ROUNDS of such faults (1); VITRINE_SEED, which is
// printed, chooses who dies and when.
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

const kSides = [220, 200, 180], kBriefSides = [70, 60]; // of the meshes
const kViewers = 3;
const kAway = 20_000; // ms that PostgreSQL, then the store, are stopped
const kLongestGap = 5_000; // ms that a viewer may see nothing when a replica that serves dies, or an engine is away
const kPatience = 200_000; // ms for anything at all
const rounds = Number(process.env.VITRINE_ROUNDS ?? 1);
const seed = Number(process.env.VITRINE_SEED ?? Date.now() % 1_000_000);
const random = chance(seed);
const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");
const oneOf = (list) => list[Math.floor(random() * list.length)];

const cluster = new Cluster(process.env.VITRINE_BIN);
let curator, viewers, passerby, technician, expected, work, failure;

/** A test that tells all that happened where it fails. */
function step(name, body) {
  test(name, async () => {
    note(`== ${name}`);
    const late = new AbortController();
    const deadline = pause(kPatience, undefined, late).then(() => Promise.reject(new Error("it takes too long")));
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
  failure = work.then(() => new Promise(() => undefined)); // never, unless somebody fails
  failure.catch(() => undefined); // each step looks at it
});

after(() => cluster.end());

/** What a build of a mesh is by itself: the SHA-256 of the file. */
async function build({ obj }, number) {
  const [source, target] = ["obj", "pmesh"].map((kind) => join(cluster.folder, `${number}.${kind}`));
  await writeFile(source, obj);
  await cluster.vitrine("build", source, "-o", target);
  return sha256(await readFile(target));
}

async function firstModel() {
  for (;; await pause(100)) {
    const order = curator.orders.find(({ model, mesh }) => model && !curator.meshes[mesh].isBrief);
    if (order) return order.model;
  }
}

/** Until what was ordered before has ended. */
async function jobsEnd() {
  for (const waiting = [...curator.orders]; waiting.some(({ model }) => !model);) await pause(200);
}

/** That something came to every viewer every now and then. */
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

/** Stops a replica that is at work on a job until another has the job. */
async function sleepsAtWork() {
  const sleeper = await cluster.builder(), held = `SELECT 1 FROM job WHERE state = 1 AND holder = '${await sleeper.holder()}'`;
  sleeper.signal("SIGSTOP");
  const isAtWork = (await cluster.postgres.query(held)).length > 0; // and not just done
  while ((await cluster.postgres.query(held)).length > 0) await pause(500);
  sleeper.signal("SIGCONT");
  return isAtWork;
}

async function buildersDieAndSleep() {
  await (await cluster.builder()).crash();
  while (!(await sleepsAtWork()));
  await jobsEnd();
}

/** In the middle of a scan: who dies goes on with it at its step, and who sleeps leaves it to another, who begins it anew. */
async function driversDieAndSleep() {
  await technician.turned(1);
  const scan = await technician.scan();
  await technician.measured(scan, 5);
  const sleeper = await cluster.driver();
  await sleeper.crash();
  await technician.measured(scan, 10);
  sleeper.signal("SIGSTOP");
  const anew = ({ log }) => log.includes(`scan ${scan.id} begins anew`);
  while (!cluster.having("scan").some(anew)) await pause(500);
  sleeper.signal("SIGCONT");
  await technician.scanned(scan);
  const other = await cluster.driver();
  assert.ok(other !== sleeper && anew(other) && !anew(sleeper), "who has begun the scan anew");
  await technician.turned(5);
}

/** The cluster without one of its engines, which has died, for a while in which somebody else dies, too. */
async function without(engine) {
  note("an engine is away");
  const from = performance.now();
  await engine.ask("kill");
  const dies = random() * kAway, victim = oneOf(cluster.replicas);
  await pause(dies);
  const dying = victim.crash();
  if (engine !== cluster.postgres) await cluster.postgres.ask("kill-backend");
  await pause(kAway - dies);
  await engine.ask("start");
  note("the engine is back");
  if (!cluster.having("serve").includes(victim)) assertSeen(from); // else its copies may have been the only ones
  await dying;
  for (const replica of cluster.replicas) await replica.ready();
  await jobsEnd();
}

for (let round = 0; round < rounds; ++round) {
  step("nginx and those that serve, build and scan die or sleep beyond their leases: others go on", () =>
    Promise.all([serversDie(), buildersDieAndSleep(), driversDieAndSleep()]));
  step("PostgreSQL is dead for a while", () => without(cluster.postgres));
  step("the store is dead for a while, in which PostgreSQL loses a process", () => without(cluster.gateway));
}

step("what everybody does ends", async () => {
  for (const somebody of [curator, passerby, technician, ...viewers]) somebody.stop();
  await work;
  assert.ok(curator.orders.length > 10 && curator.deleted.size > 1, `${curator.orders.length} orders`);
  assert.ok(passerby.looks.length > 10 && technician.turns > 10, `${passerby.looks.length} looks, ${technician.turns} turns`);
  assert.ok(viewers.some(({ resumed }) => resumed > 0), "no viewer has met a replica that died");
});

step("viewers had what is true, and nobody a half model", () => {
  for (const viewer of viewers) assert.ok(!viewer.fault && viewer.rounds > 0, `${viewer.rounds} rounds: ${viewer.fault}`);
  assert.deepEqual(invariants.halfVisible(passerby.looks, curator.deleted), []);
});

step("every job has ended in one model, once", async () => {
  assert.deepEqual(invariants.unfinished([...curator.orders, ...technician.scans]), []);
  assert.deepEqual(invariants.doneTwice((await cluster.postgres.query("SELECT job FROM done")).flat()), []);
  assert.deepEqual(invariants.differentResults(await cluster.postgres.query("SELECT model, file FROM published")), []);
  const { body: { models } } = await cluster.visitor.json("GET", "/models?limit=200");
  assert.deepEqual(invariants.unordered(models.map(({ id }) => id), [...curator.orders, ...technician.scans], curator.deleted), []);
});

step("every model is what a build by itself makes, bit for bit; nothing that lives was collected", async () => {
  const named = (await cluster.postgres.query("SELECT DISTINCT encode(file, 'hex') FROM model")).flat();
  assert.deepEqual(invariants.collectedAlive(named, await cluster.gateway.objects()), []);
  const [cold] = cluster.having("serve");
  await cold.crash(); // what it has fetched is gone with it
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
