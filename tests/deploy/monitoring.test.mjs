// SPDX-License-Identifier: Apache-2.0
// Tests the alerts and the dashboard (deploy/monitoring): they use only metrics that the real daemon exports, and each
// alert fires under its condition.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file), VITRINE_PROMTOOL.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { cp, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { Daemon } from "../e2e/daemon.mjs";

const { parse } = createRequire(new URL("../../web/package.json", import.meta.url))("yaml");
const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_PROMTOOL: promtool } = process.env;
const shipped = fileURLToPath(new URL("../../deploy/monitoring/", import.meta.url));
let folder, samples, rules, dashboard;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vitrine-"));
  await cp(shipped, folder, { recursive: true });
  const daemon = await Daemon.start(bin);
  await daemon.publish(scan, "Demosthenes");
  samples = (await daemon.metrics()).map(([name, labels]) => ({ name, labels: labelsOf(labels) }));
  await daemon.stop();
  rules = parse(await readFile(join(folder, "alerts.yml"), "utf8")).groups.flatMap((group) => group.rules);
  dashboard = JSON.parse(await readFile(join(folder, "dashboard.json"), "utf8"));
});
after(() => rm(folder, { recursive: true, force: true }));

/** Returns the labels in a text such as `{route="/",status="2xx"}`, and the labels that Prometheus adds. */
function labelsOf(text) {
  const own = [...text.matchAll(/(\w+)="([^"]*)"/g)].map(([, name, value]) => [name, value]);
  return { instance: "a", job: "vitrine", ...Object.fromEntries(own) };
}

const holds = {
  "=": (value, wanted) => value === wanted,
  "!=": (value, wanted) => value !== wanted,
  "=~": (value, wanted) => new RegExp(`^(?:${wanted})$`).test(value),
  "!~": (value, wanted) => !new RegExp(`^(?:${wanted})$`).test(value),
};

/** Whether the daemon exports a sample that has this name and whose labels satisfy all `matchers`. */
function isTold({ name, matchers }) {
  return samples.some((sample) => sample.name === name && matchers.every(([label, how, wanted]) => holds[how](sample.labels[label] ?? "", wanted)));
}

function selectors(expression) {
  return [...expression.replaceAll("$instance", ".*").matchAll(/\b(vitrine_\w+)(?:\{((?:"[^"]*"|[^}"])*)\})?/g)].map(([text, name, inside]) => ({
    text, name, matchers: [...(inside ?? "").matchAll(/(\w+)\s*(=~|!~|!=|=)\s*"([^"]*)"/g)].map(([, ...parts]) => parts),
  }));
}

const expressions = () => [...rules.map(({ expr }) => expr), ...dashboard.panels.flatMap(({ targets }) => targets.map(({ expr }) => expr))];
const check = (...words) => promisify(execFile)(promtool, words, { cwd: folder });

test("the daemon exports every sample that alerts and dashboard use", () => {
  const asked = expressions().flatMap(selectors);
  assert.ok(asked.length > 30);
  for (const selector of asked) assert.ok(isTold(selector), selector.text);
});

test("a selector without samples is found", () => {
  for (const text of ["vitrine_stream", 'vitrine_jobs{state="lost"}', 'vitrine_http_requests_total{route=~"/api/v2/.*"}'])
    assert.ok(selectors(text).every((selector) => !isTold(selector)), text);
});

test("alerts and configuration are valid, and each alert fires under its condition", async () => {
  await check("check", "config", "prometheus.yml");
  let tried = "";
  for (const tests of ["alerts_test.yml", "alerts_of_weeks_test.yml"]) {
    await cp(new URL(tests, import.meta.url), join(folder, tests));
    await check("test", "rules", tests);
    tried += await readFile(join(folder, tests), "utf8");
  }
  for (const { alert, annotations, labels } of rules) {
    assert.equal(tried.split(`alertname="${alert}"`).length > 1 && tried.split(`alertname: ${alert}`).length > 1, true, `${alert} is not tried`);
    assert.ok(annotations.summary && annotations.description, alert);
    assert.match(labels.severity, /^(page|ticket)$/);
  }
});

test("the dashboard's expressions are valid, and its panels do not overlap", async () => {
  const file = { groups: [{ name: "dashboard", rules: dashboard.panels.flatMap(({ id, targets }) =>
    targets.map(({ expr, refId }) => ({ record: `panel:${id}:${refId}`, expr: expr.replaceAll("$instance", ".*") }))) }] };
  await writeFile(join(folder, "dashboard.yml"), JSON.stringify(file));
  await check("check", "rules", "dashboard.yml");
  const taken = new Set();
  for (const { title, gridPos: { x, y, w, h } } of dashboard.panels) {
    assert.ok(x + w <= 24, title);
    for (let i = 0; i < w * h; ++i) {
      const place = `${x + (i % w)} ${y + Math.floor(i / w)}`;
      assert.ok(!taken.has(place), title);
      taken.add(place);
    }
  }
  assert.equal(new Set(dashboard.panels.map(({ id }) => id)).size, dashboard.panels.length);
});
