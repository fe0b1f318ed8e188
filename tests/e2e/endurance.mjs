// SPDX-License-Identifier: Apache-2.0
// endurance.mjs BIN_FOLDER MODEL [SWITCHES]: one page shows two models in turn, refining each to the
// last triangle, 100 times by default; prints the JavaScript heap of the page and the memory of the
// daemon on the way and fails where either ends more than a quarter above the first tenth.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";

const [bin, scan, count = "100"] = process.argv.slice(2);
const switches = Number(count);
if (!scan || !(switches > 0)) {
  console.error("usage: endurance.mjs BIN_FOLDER MODEL [SWITCHES]");
  process.exit(2);
}

const daemon = await Daemon.start(bin);
const browser = await launch();
try {
  const sources = [];
  for (const title of ["one", "two"]) {
    sources.push((await daemon.publish(scan, title)).replace("/models/", "/api/v1/models/"));
  }
  const viewer = await ViewerPage.open(browser, sources[0].replace("/api/v1", ""));
  await viewer.releaseLayers();
  await viewer.events("load");
  const devtools = await viewer.page.context().newCDPSession(viewer.page);

  const measure = async () => {
    await devtools.send("HeapProfiler.collectGarbage");
    const { usedSize } = await devtools.send("Runtime.getHeapUsage");
    const status = await readFile(`/proc/${daemon.child.pid}/status`, "utf8");
    return { page: usedSize / 1e6, daemon: Number(status.match(/VmRSS:\s+(\d+)/)[1]) / 1e3 };
  };

  let first;
  for (let i = 1; i <= switches; ++i) {
    await viewer.settled(() =>
      viewer.page.locator("progressive-mesh").evaluate((element, src) => element.setAttribute("src", src), sources[i % 2]));
    if (i % Math.ceil(switches / 10) !== 0) continue;
    const now = await measure();
    first ??= now;
    console.log(`${i} switches: page ${now.page.toFixed(1)} MB, daemon ${now.daemon.toFixed(1)} MB`);
    if (i === switches) {
      for (const part of ["page", "daemon"]) {
        assert.ok(now[part] <= 1.25 * first[part], `the ${part} grew from ${first[part]} to ${now[part]} MB`);
      }
    }
  }
  assert.deepEqual(await viewer.complaints(), []);
} finally {
  await browser.close();
  await daemon.stop();
}
