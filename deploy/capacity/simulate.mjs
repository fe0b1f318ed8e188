#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Simulates how many viewers a machine can serve without a cache and with caches of several sizes.
// Usage: simulate.mjs [FILE.json]; the values in FILE override the values of the scenario below.
// tests/deploy/capacity.test.mjs compares the simulation with a real nginx in front of a real daemon.
import { readFileSync } from "node:fs";
import { DiskCache, room, serve } from "./cache.mjs";
import { catalogue, chance, looks } from "./visitors.mjs";

const kScenario = {
  seed: 1,
  models: { count: 1000, bytes: 1.8e6, chunkBytes: 16384 },
  // exponent: exponent of Zipf's law. looks: mean number of models that a visitor opens. seconds:
  // mean time that a visitor looks at one model. streams: share of looks over a WebSocket stream.
  // lines: speeds of connections, and the share of visitors with each speed.
  visitor: {
    exponent: 0.8, looks: 4, seconds: 30, streams: 0.1,
    lines: [{ share: 0.2, bytesPerSecond: 1e5 }, { share: 0.5, bytesPerSecond: 1e6 }, { share: 0.3, bytesPerSecond: 5e6 }],
  },
  visits: 8000,  // simulated visits; only the second half is counted
  caches: [0.05, 0.1, 0.25, 0.5, 1.01],  // cache sizes, as shares of the space that all chunks need
  managed: 5000,  // chunk requests between two runs of the cache manager
  // Number and total bytes of the uncached responses for each opened model: page, model, manifest
  // and head.
  answers: { count: 4, bytes: 40e3 },
  // Responses per second measured on one core, and bytes per second of a link of one gigabit per
  // second (CAPACITY.md).
  machine: { chunksPerSecond: 73220, answersPerSecond: 88570, bytesPerSecond: 117e6 },
};

/**
 * Returns the share of bytes from the cache, the bytes that the origin sends for each opened model,
 * and the numbers of viewers that one core and one gigabit per second can serve.
 */
export function load(sum, { answers, machine, visitor }) {
  const chunks = sum.originChunks / sum.looks;
  const streamed = sum.streamBytes / sum.looks;
  const bytes = sum.originBytes / sum.looks + streamed + answers.bytes;
  const coreSeconds = chunks / machine.chunksPerSecond + answers.count / machine.answersPerSecond +
    streamed / (machine.chunksPerSecond * 16384);
  return {
    hits: 1 - sum.originBytes / sum.bytes,
    bytes,
    viewersOfCore: visitor.seconds / coreSeconds,
    viewersOfGigabit: (visitor.seconds * machine.bytesPerSecond) / bytes,
  };
}

function run(scenario, models, capacity) {
  const { visits, visitor, managed, seed } = scenario;
  const cache = new DiskCache(capacity);
  const random = chance(seed);
  serve(looks(models, visits / 2, visitor, random), models, cache, managed);
  return load(serve(looks(models, visits / 2, visitor, random), models, cache, managed), scenario);
}

function row(name, { hits, bytes, viewersOfCore, viewersOfGigabit }) {
  const numbers = [(100 * hits).toFixed(1), (bytes / 1e3).toFixed(0), viewersOfCore.toFixed(0), viewersOfGigabit.toFixed(0)];
  console.log(`| ${[name, ...numbers].join(" | ")} |`);
}

function main(file) {
  const scenario = { ...kScenario, ...(file ? JSON.parse(readFileSync(file, "utf8")) : {}) };
  const models = catalogue(scenario.models, chance(scenario.seed));
  const all = models.flat().reduce((sum, bytes) => sum + room(bytes), 0);
  console.log("| cache, share of the catalogue | hit, % | origin kB a look | viewers a core | viewers a gigabit |");
  console.log("|---|---|---|---|---|");
  row("none", run({ ...scenario, managed: 1 }, models, 0));
  for (const share of scenario.caches) row(share > 1 ? "all" : share, run(scenario, models, share * all));
}

if (process.argv[1] === new URL(import.meta.url).pathname) main(process.argv[2]);
