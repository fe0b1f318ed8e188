// SPDX-License-Identifier: Apache-2.0
// endurance.mjs BIN_FOLDER MODEL [SWITCHES [MINUTES]]: tests for memory leaks. One page, whose worker is never stopped,
// shows two models alternately and refines each to the last triangle, 100 times. Then one model rotates for 20 minutes
// while the camera approaches and recedes. Prints the memory of page, worker, WebAssembly, WebGL and daemon. Fails if
// the second half of either part uses over 10 % (and 1 MB) more than the first half.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { Memory, countWebGl } from "./memory.mjs";

// Limit for the mean of the second half of the kSamples samples: kMost times the mean of the first
// half, plus kNoise MB.
const kSamples = 10, kMost = 1.1, kNoise = 1;
const kOrbits = ["30deg 75deg 60%", "120deg 60deg 30%", "210deg 90deg 150%", "300deg 75deg 40%"];
const kStay = 5000; // ms that the camera stays at each orbit

const [bin, scan, switches = 100, minutes = 20] = process.argv.slice(2).map((word, i) => (i < 2 ? word : Number(word)));
if (!scan || !(switches >= kSamples) || !(minutes >= 0)) {
  console.error(`Usage: endurance.mjs BIN_FOLDER MODEL [SWITCHES [MINUTES]]   SWITCHES at least ${kSamples}`);
  process.exit(2);
}

const daemon = await Daemon.start(bin);
const browser = await launch();
try {
  const sources = [];
  for (const title of ["one", "two"]) {
    sources.push((await daemon.publish(scan, title)).replace("/models/", "/api/v1/models/"));
  }
  const viewer = await ViewerPage.open(browser, sources[0].replace("/api/v1", ""), { init: countWebGl, reducedMotion: "no-preference" });
  viewer.page.setDefaultTimeout(300_000);
  await viewer.releaseLayers();
  await viewer.events("load");
  await companion(viewer, sources[0]);
  const memory = await Memory.of(viewer.page);
  await endure(`${switches} switches`, memory, (tenth) => switchModels(viewer, sources, tenth));
  if (minutes > 0) {
    await turn(viewer);
    await endure(`${minutes} minutes of turning`, memory, () => lookAround(viewer, 60_000 * minutes / kSamples));
  }
  assert.deepEqual(await viewer.complaints(), []);
} finally {
  await browser.close();
  await daemon.stop();
}

/**
 * Adds a second viewer that shows only its base mesh, so that the worker does not stop when the
 * first viewer changes its model.
 */
async function companion({ page }, src) {
  await page.evaluate((url) => new Promise((resolve) => {
    const second = document.createElement("progressive-mesh");
    second.addEventListener("load", resolve, { once: true });
    second.dataset.dressed = second.id = "companion";
    second.setAttribute("max-triangles", "0");
    second.src = url;
    document.body.append(second);
  }), src);
}

/**
 * Runs `work` kSamples times and measures the memory after each run. Fails if the second half of
 * the samples needs more memory than the first.
 */
async function endure(what, memory, work) {
  const samples = [];
  for (let tenth = 0; tenth < kSamples; ++tenth) {
    await work(tenth);
    // Empties the test's own list of events, whose growth would otherwise count as a leak.
    await memory.page.evaluate(() => (window.seen.length = 0));
    const held = { ...(await memory.measure()), daemon: await residentMegabytes() };
    samples.push(held);
    console.log(`${tenth + 1}/${kSamples} of ${what}: ${Object.entries(held).map(([name, value]) => `${name} ${+value.toFixed(1)}`).join(", ")}`);
  }
  const mean = (some, name) => some.reduce((sum, held) => sum + held[name], 0) / some.length;
  const halves = Object.keys(samples[0]).map((name) => [name, mean(samples.slice(0, kSamples / 2), name), mean(samples.slice(kSamples / 2), name)]);
  const growth = ([name, first, second]) => `${name} ${second < first ? "" : "+"}${(100 * (second / first - 1)).toFixed(1)} %`;
  console.log(`second half of ${what} against the first: ${halves.map(growth).join(", ")}`);
  const grown = halves.filter(([, first, second]) => second > kMost * first + kNoise);
  assert.deepEqual(grown, [], `more in the second half of ${what}`);
}

async function switchModels(viewer, sources, tenth) {
  // Uses even numbers of model changes, so that each of the kSamples runs ends with the first
  // model.
  const [from, to] = [tenth, tenth + 1].map((n) => 2 * Math.round(n * switches / kSamples / 2));
  for (let i = from; i < to; ++i) {
    await viewer.settled(() => viewer.page.locator("progressive-mesh").first().evaluate((element, src) => (element.src = src), sources[(i + 1) % 2]));
  }
}

function turn({ page }) {
  return page.locator("progressive-mesh").first().evaluate((element) => {
    element.setAttribute("pixel-error", "1");
    element.toggleAttribute("auto-rotate", true);
  });
}

/** Moves the camera through all orbits at least once, and repeats this for `milliseconds`. */
async function lookAround(viewer, milliseconds) {
  const end = performance.now() + milliseconds;
  do {
    for (const orbit of kOrbits) {
      const moved = viewer.page.locator("progressive-mesh").first().evaluate((element, to) => element.setAttribute("camera-orbit", to), orbit);
      await Promise.all([moved, new Promise((resolve) => setTimeout(resolve, Math.min(kStay, milliseconds / kOrbits.length)))]);
    }
  } while (performance.now() < end);
}

async function residentMegabytes() {
  const status = await readFile(`/proc/${daemon.child.pid}/status`, "utf8");
  return Number(status.match(/VmRSS:\s+(\d+)/)[1]) / 1e3;
}
