// SPDX-License-Identifier: Apache-2.0
// Compares the simulation behind deploy/CAPACITY.md with a real installation. The same visitors use a real nginx, whose
// cache is too small for all models, in front of a real daemon. The counts of requests and bytes must agree within 2 %.
// Environment: VITRINE_BIN.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, readdir, readFile, rm, stat, writeFile } from "node:fs/promises";
import https from "node:https";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { DiskCache, serve } from "../../deploy/capacity/cache.mjs";
import { chance, looks } from "../../deploy/capacity/visitors.mjs";
import { Daemon } from "../e2e/daemon.mjs";
import { Nginx } from "../e2e/nginx.mjs";

const kModels = 10, kVisits = 150, kManaged = 100, kCapacity = 200 * 1024;
const visitor = { exponent: 0.8, looks: 2, seconds: 4, streams: 0, lines: [{ share: 0.3, bytesPerSecond: 800 }, { share: 0.7, bytesPerSecond: 8000 }] };
let daemon, nginx, ca, folder, agent, ids, manifests;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vitrine-"));
  daemon = await Daemon.start(process.env.VITRINE_BIN);
  const publish = async (i) => {
    const file = join(folder, `${i}.obj`);
    await writeFile(file, bumps(i));
    return (await daemon.publish(file, `Bumps ${i}`)).split("/").pop();
  };
  ids = await Promise.all(Array.from({ length: kModels }, (_, i) => publish(i)));
  manifests = await Promise.all(ids.map(async (id) => (await fetch(`${daemon.url}/api/v1/models/${id}/manifest`)).json()));
  nginx = await Nginx.start([`127.0.0.1:${daemon.port}`], [["max_size=50g", `max_size=${kCapacity}`]]);
  ca = await readFile(nginx.certificate);
});

after(async () => {
  agent?.destroy();
  await nginx?.stop();
  await daemon?.stop();
  await rm(folder, { recursive: true, force: true });
});

/** Returns an OBJ file with a relief that differs for each number. */
function bumps(number) {
  const random = chance(number + 1), side = 60, lines = [];
  for (let i = 0; i < side * side; ++i) lines.push(`v ${i % side} ${Math.floor(i / side)} ${(3 * random()).toFixed(3)}`);
  for (let i = 0; i < side * (side - 1); ++i) {
    if (i % side < side - 1) lines.push(`f ${i + 1} ${i + 2} ${i + side + 2}`, `f ${i + 1} ${i + side + 2} ${i + side + 1}`);
  }
  return lines.join("\n");
}

async function ask(path) {
  const request = https.get(nginx.url + path, { ca, agent });
  const [response] = await once(request, "response");
  for await (const _ of response);
  assert.equal(response.statusCode, 200, path);
}

/** Reloads nginx, so that the cache manager runs immediately, and waits until the cache has free space. */
async function managed() {
  agent.destroy();
  agent = new https.Agent({ keepAlive: true });
  await nginx.reload();
  while ((await diskUse(nginx.cache)) >= kCapacity);
}

async function diskUse(path) {
  let sum = 0;
  for (const { name, parentPath, path: parent } of (await readdir(path, { withFileTypes: true, recursive: true })).filter((entry) => entry.isFile()))
    sum += await stat(join(parentPath ?? parent, name)).then(({ blocks }) => blocks * 512, () => 0);
  return sum;
}

const origin = async (name, route) => (await daemon.metrics())
  .filter(([metric, labels]) => metric === name && labels.includes(`route="${route}"`)).reduce((sum, [, , value]) => sum + value, 0);
const kChunk = "/api/v1/chunks/{sha256}", kHead = "/api/v1/models/{id}/head";

function near(real, simulated, what, tolerance = 0.02) {
  assert.ok(Math.abs(real - simulated) <= tolerance * real, `${what}: ${real}, but ${simulated} in the simulation`);
}

test("the simulation sends the origin as many requests as nginx", async () => {
  const models = manifests.map(({ chunks }) => chunks.map(({ length }) => length));
  const simulated = serve(looks(models, kVisits, visitor, chance(7)), models, new DiskCache(kCapacity), kManaged);
  agent = new https.Agent({ keepAlive: true });
  let asked = 0, seen = 0;
  for (const { model, chunks } of looks(models, kVisits, visitor, chance(7))) {
    ++seen;
    await ask(`/api/v1/models/${ids[model]}/head`);
    for (let i = 0; i < chunks; ++i) {
      await ask(`/api/v1/chunks/${manifests[model].chunks[i].sha256}`);
      if (++asked % kManaged === 0) await managed();
    }
  }
  const [requests, bytes] = [await origin("vitrine_http_requests_total", kChunk), await origin("vitrine_http_response_bytes_total", kChunk)];
  assert.equal(asked, simulated.chunks);
  assert.ok(simulated.originChunks < 0.6 * simulated.chunks && simulated.originChunks > 2 * models.flat().length, "the cache must be useful, and too small");
  near(requests, simulated.originChunks, "chunk requests");
  near(bytes, simulated.originBytes, "chunk bytes");
  near(await origin("vitrine_http_requests_total", kHead), seen, "heads");
});

test("a cache with space for all requests each chunk once", () => {
  const models = Array(50).fill([100, 200, 300]);
  const sum = serve(looks(models, 5000, { ...visitor, seconds: 1000 }, chance(3)), models, new DiskCache(1e9), 1);
  assert.equal(sum.originChunks, 150);
});

test("the most popular model is viewed as often as Zipf's law says", () => {
  const models = Array(100).fill([1]);
  const all = [...looks(models, 20000, visitor, chance(5))];
  const law = Array.from(models, (_, i) => (i + 1) ** -visitor.exponent);
  near(all.filter(({ model }) => model === 0).length / all.length, 1 / law.reduce((sum, share) => sum + share), "share of the first", 0.05);
  near(all.length / 20000, visitor.looks, "looks a visit", 0.05);
});

test("CAPACITY.md contains the table that the simulation prints", async () => {
  const deploy = new URL("../../deploy/", import.meta.url);
  const table = execFileSync(process.execPath, [new URL("capacity/simulate.mjs", deploy).pathname], { encoding: "utf8" });
  assert.ok((await readFile(new URL("CAPACITY.md", deploy), "utf8")).includes(table), table);
});
