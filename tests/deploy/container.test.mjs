// SPDX-License-Identifier: Apache-2.0
// Checks the container files with their linter, and runs the parts that need no container engine.
// Environment: VITRINE_BIN.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { readdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { Daemon } from "../e2e/daemon.mjs";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const { validate } = require("dockerfile-utils");
const { DockerfileParser } = require("dockerfile-ast");
const root = fileURLToPath(new URL("../../", import.meta.url));
let files;

before(async () => {
  const all = await readdir(join(root, "deploy"), { recursive: true });
  const names = all.filter((name) => name.endsWith("Containerfile"));
  assert.ok(names.length > 0);
  files = await Promise.all(names.map(async (name) => {
    const text = await readFile(join(root, "deploy", name), "utf8");
    return { name, text, parsed: DockerfileParser.parse(text) };
  }));
});

const instructions = (file, keyword) => file.parsed.getInstructions().filter((one) => one.getKeyword() === keyword);

test("container files pass their linter", () => {
  for (const { name, text } of files) assert.deepEqual(validate(text).map(({ message, range }) => `${name}:${range.start.line + 1}: ${message}`), []);
  assert.notDeepEqual(validate("FROM debian\nCOPPY . .\n"), []);
});

test("images have versions, and package lists are removed", () => {
  for (const file of files) {
    for (const from of file.parsed.getFROMs()) assert.match(from.getImage(), /^[a-z/-]+:(?!latest)[\w.-]+$/, file.name);
    for (const run of instructions(file, "RUN").map((one) => one.getArgumentsContent()).filter((text) => text.includes("apt-get install"))) {
      assert.match(run, /apt-get update\s.*apt-get install --yes --no-install-recommends .*rm -rf \/var\/lib\/apt\/lists/s, file.name);
    }
  }
});

test("files that are copied from the clone exist", () => {
  for (const file of files) {
    for (const copy of file.parsed.getCOPYs().filter((one) => !one.getFlags().some((flag) => flag.getName() === "from"))) {
      const sources = copy.getArguments().slice(0, -1).map((one) => one.getValue());
      for (const source of sources) assert.ok(existsSync(join(root, source)), `${file.name}: ${source}`);
    }
  }
});

const image = () => files.find(({ name }) => name === "container/Containerfile");

test("the daemon runs as an unprivileged user, given by number", () => {
  assert.equal(instructions(image(), "USER").at(-1).getArgumentsContent(), "65532:65532");
});

test("the daemon accepts the image's settings", () => {
  const settings = instructions(image(), "ENV").flatMap((one) => one.getArguments().map((argument) => argument.getValue().split("=")));
  assert.equal(settings.length, 3);
  const env = { PATH: process.env.PATH, ...Object.fromEntries(settings), VITRINE_DATA: "/tmp" };
  const { status, stderr } = spawnSync(join(process.env.VITRINE_BIN, "vitrined"), ["--print-config"], { env, encoding: "utf8" });
  assert.equal(status, 0, stderr);
});

test("the health check succeeds for a ready daemon only", async () => {
  const [check] = instructions(image(), "HEALTHCHECK");
  const command = JSON.parse(check.getArgumentsContent().replace(/^.*?CMD /s, ""));
  const healthy = (port) => spawnSync(command[0], command.slice(1).map((word) => word.replace("/9400", `/${port}`))).status === 0;
  const daemon = await Daemon.start(process.env.VITRINE_BIN);
  assert.ok(healthy(daemon.adminPort));
  await daemon.stop();
  assert.ok(!healthy(daemon.adminPort));
});
