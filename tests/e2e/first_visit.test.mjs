// SPDX-License-Identifier: Apache-2.0
// Tests the cost of a first visit until the first picture: the order of the requests, their number, and the bytes of the
// model.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { ViewerPage, launch } from "./browser.mjs";
import { StaticHost } from "./static_host.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan } = process.env;

/** Files that the viewer needs for the first picture, besides its script and the model. */
const kParts = ["three.js", "progressive-mesh-stage.js", "progressive-mesh-en.js", "progressive-mesh.wasm"];

let folder, host, browser;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vitrine-"));
  const file = join(folder, "model.pmesh");
  execFileSync(join(bin, "vitrine"), ["build", scan, "-o", file], { stdio: "ignore" });
  host = await StaticHost.start();
  host.add("model.pmesh", await readFile(file));
  browser = await launch();
});
after(async () => {
  await browser?.close();
  host?.stop();
  await rm(folder, { recursive: true });
});

/**
 * Opens a page that shows the model. Holds the requests for `held` until the returned function `release` is
 * called.
 */
async function open(held, init) {
  const asked = [], waiting = [];
  let isHolding = true;
  const viewer = await ViewerPage.open(browser, "about:blank", { init });
  await viewer.page.context().route(`${host.url}/**`, (route) => {
    const name = new URL(route.request().url()).pathname.slice(1);
    asked.push(name);
    if (isHolding && held.includes(name)) waiting.push(route);
    else void route.continue();
  });
  const release = () => {
    isHolding = false;
    return Promise.all(waiting.splice(0).map((route) => route.continue()));
  };
  await viewer.page.goto(host.page({ src: "model.pmesh", "max-triangles": "0" }), { waitUntil: "commit" });
  return { viewer, asked, release, until: async (isReached) => { while (!isReached()) await viewer.frames(); } };
}

test("requests everything for the first picture together, as soon as the viewer's script has run", { timeout: 120_000 }, async () => {
  const { viewer, asked, release, until } = await open([...kParts, "model.pmesh"]);
  await until(() => asked.length >= kParts.length + 3);
  const [, script, ...parts] = [...asked];
  assert.equal(script, "progressive-mesh.js");
  assert.equal(parts[0], "three.js", "the largest file takes the open connection");
  assert.deepEqual(new Set(parts), new Set([...kParts, "model.pmesh"]));
  await release();
  await viewer.events("first-paint");
  await viewer.page.context().close();
});

test("the page asks for the model before the worker runs", { timeout: 120_000 }, async () => {
  // Replaces the page's Worker by a class whose workers never start.
  host.asked = [];
  const { viewer, until } = await open([], () => (window.Worker = class { postMessage() {} terminate() {} }));
  await until(() => host.asked.some((line) => line.includes("model.pmesh")));
  await viewer.page.context().close();
});

test("the first picture takes one request for the model, of 16 KB", { timeout: 120_000 }, async () => {
  host.asked = [];
  host.sent = [];
  const { viewer } = await open([]);
  await viewer.events("first-paint");
  assert.deepEqual(host.asked.filter((line) => line.includes("model.pmesh")), ["GET /model.pmesh bytes=0-16383"]);
  assert.ok(host.sent.find(({ path }) => path === "/model.pmesh").bytes <= 16_384);
  await viewer.page.context().close();
});

test("the first picture shows the model, also if three.js arrives last", { timeout: 120_000 }, async () => {
  const { viewer, release } = await open(["three.js"], () => {
    window.heard = [];
    window.Worker = class extends Worker {
      constructor(url) {
        super(url);
        this.addEventListener("message", ({ data: { type, change } }) => window.heard.push({ type, blocks: change?.blocks }));
      }
    };
    window.drawn = new Promise((resolve) => document.addEventListener("first-paint", ({ target }) => {
      const copy = document.createElement("canvas").getContext("2d");
      copy.drawImage(target.shadowRoot.querySelector("canvas"), 0, 0, 300, 150);
      resolve(copy.getImageData(0, 0, 300, 150).data.filter((value, i) => i % 4 === 3 && value > 0).length);
    }, true));
  });
  await viewer.page.waitForFunction(() => {
    const change = window.heard.find(({ type }) => type === "change");
    return change && window.heard.filter(({ type }) => type === "block").length >= change.blocks;
  });
  await release();
  assert.ok((await viewer.page.evaluate(() => window.drawn)) > 1000);
  await viewer.page.context().close();
});
