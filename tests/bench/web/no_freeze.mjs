// SPDX-License-Identifier: Apache-2.0
// no_freeze.mjs BIN_FOLDER MESH|FILE.pmesh: refines a model to its last triangle in Chromium,
// slowed down to a quarter of its speed, and traces the page's main thread. Prints the CPU time for
// processing the decoder's results. Fails if one task spends more than 12 ms on this processing.
// Also prints, without a limit, the time of the browser's garbage collection and of drawing by
// three.js and the software renderer.
import { execFileSync } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { ViewerPage, launch } from "../../e2e/browser.mjs";
import { StaticHost } from "../../e2e/static_host.mjs";

// Factor by which Chromium is slowed down, and the limit of a task in ms of CPU time.
const kSlowDown = 4, kMost = 12;
const kCategories = ["toplevel", "devtools.timeline", "blink.user_timing", "v8"];
const kCollection = /^(MajorGC|MinorGC|V8\.GCIncrementalMarking.*)$/;

const [bin, mesh] = process.argv.slice(2);
if (!mesh) {
  console.error("Usage: no_freeze.mjs BIN_FOLDER MESH|FILE.pmesh");
  process.exit(2);
}

const folder = await mkdtemp(join(tmpdir(), "vitrine-"));
const host = await StaticHost.start();
const browser = await launch();
try {
  const viewer = await ViewerPage.open(browser, host.page({ src: await served(), "pixel-error": 0, "max-triangles": 0 }), {
    width: 480, height: 360, reducedMotion: "no-preference", attributes: {},
  });
  await viewer.events("load");
  const tracing = await viewer.page.context().newCDPSession(viewer.page);
  await tracing.send("Emulation.setCPUThrottlingRate", { rate: kSlowDown });
  const events = await traced(tracing, async () => {
    await viewer.page.locator("progressive-mesh").evaluate((element) => element.removeAttribute("max-triangles"));
    await viewer.page.waitForFunction(() => window.seen.filter(({ type }) => type === "load").length === 2, null, { timeout: 600_000 });
  });
  const tasks = judge(events);
  const longest = (part) => Math.max(...tasks.map((task) => task[part]));
  const sum = (part) => tasks.reduce((all, task) => all + task[part], 0);
  const changes = (await viewer.seen()).filter(({ type }) => type === "refine").length;
  console.log(`${await viewer.triangles()} triangles in ${changes} changes, ${tasks.length} tasks, main thread at 1/${kSlowDown} of its speed`);
  console.log(`taking over: longest task ${longest("ours").toFixed(1)} ms of CPU time (at most ${kMost}), all ${sum("ours").toFixed(0)} ms`);
  console.log(`garbage collection within: longest ${longest("collection").toFixed(1)} ms, all ${sum("collection").toFixed(0)} ms`);
  console.log(`all of those tasks, drawing included: longest ${longest("whole").toFixed(1)} ms, all ${sum("whole").toFixed(0)} ms`);
  process.exitCode = longest("ours") <= kMost ? 0 : 1;
} finally {
  await browser.close();
  host.stop();
  await rm(folder, { recursive: true });
}

async function served() {
  const file = mesh.endsWith(".pmesh") ? mesh : join(folder, "model.pmesh");
  if (file !== mesh) execFileSync(join(bin, "vitrine"), ["build", mesh, "--force", "-o", file], { stdio: ["ignore", "ignore", "inherit"] });
  return host.add("model.pmesh", await readFile(file));
}

/** Returns all trace events that occur while `work` runs. */
async function traced(tracing, work) {
  const events = [];
  tracing.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  await tracing.send("Tracing.start", { transferMode: "ReportEvents", traceConfig: { includedCategories: kCategories } });
  await work();
  const complete = new Promise((resolve) => tracing.once("Tracing.tracingComplete", resolve));
  await tracing.send("Tracing.end");
  await complete;
  return events;
}

/**
 * Returns the page's tasks on the main thread that process the decoder's results. Each task has CPU
 * times in ms: `ours` for the processing, `collection` for the garbage collection within the
 * processing, and `whole` for the whole task.
 */
function judge(events) {
  const isMark = ({ name }) => name.startsWith("progressive-mesh:");
  const { pid, tid } = events.find(isMark) ?? fail("the trace has no mark of the viewer");
  const main = events.filter((event) => event.pid === pid && event.tid === tid && event.tts !== undefined);
  const complete = (named) => main.filter(({ name, ph }) => ph === "X" && named(name)).map(({ tts, tdur }) => [tts, tdur]);
  const spans = complete((name) => name === "HandlePostMessage");
  const marks = main.filter(isMark).sort((a, b) => a.tts - b.tts);
  for (let i = 0; i + 1 < marks.length; ++i) {
    if (marks[i].name.endsWith("begin")) spans.push([marks[i].tts, marks[i + 1].tts - marks[i].tts]);
  }
  const collections = outermost(complete((name) => kCollection.test(name)));
  const length = (found) => found.reduce((all, [, one]) => all + one, 0) / 1000;
  return complete((name) => name.endsWith("RunTask")).map((task) => {
    const ours = inside(task, spans);
    const collection = length(ours.flatMap((span) => inside(span, collections)));
    return { ours: length(ours) - collection, collection, whole: task[1] / 1000 };
  }).filter(({ ours }) => ours > 0);
}

function inside([from, length], spans) {
  return spans.filter(([at]) => at >= from && at < from + length);
}

function outermost(spans) {
  return spans.filter((span) => !spans.some((other) => other !== span && other[1] > span[1] && inside(other, [span]).length > 0));
}

function fail(reason) {
  throw new Error(reason);
}
