// SPDX-License-Identifier: Apache-2.0
// Tests the daemon's OpenAPI document with linters and with generators of client code. Compiles the generated clients and runs
// them against the daemon.
// node --test openapi.test.mjs
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, symlinkSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { after, before, test } from "node:test";
import { Museum } from "./museum.mjs";

const here = fileURLToPath(new URL("./", import.meta.url));
// Turns off the tools' usage reports to their makers.
const env = { ...process.env, REDOCLY_TELEMETRY: "off", REDOCLY_SUPPRESS_UPDATE_NOTICE: "true", SCARF_ANALYTICS: "false", DO_NOT_TRACK: "1" };

let museum, folder;
before(async () => {
  museum = await Museum.open();
  folder = join(museum.daemon.folder, "openapi");
  mkdirSync(folder);
  symlinkSync(join(here, "node_modules"), join(folder, "node_modules"));
  copyFileSync(join(here, "spectral.yaml"), join(folder, "spectral.yaml"));
  writeFileSync(join(folder, "package.json"), `{ "type": "module" }`);
  writeFileSync(join(folder, "openapi.json"), JSON.stringify(await museum.json("/api/v1/openapi.json")));
});
after(() => museum?.stop());

/** Runs a program of the installed packages in the folder of the document. Returns its output. */
function run(program, ...args) {
  try {
    return execFileSync(join(here, "node_modules/.bin", program), args, { cwd: folder, env, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
  } catch ({ stdout, stderr }) {
    throw new Error(`${program} fails: ${stdout}${stderr}`);
  }
}

/** Compiles the program NAME.ts strictly and runs it with the daemon's URL and a model. Returns the JSON that it prints. */
function compiledAndRun(name) {
  copyFileSync(join(here, "programs", `${name}.ts`), join(folder, `${name}.ts`));
  run("tsc", "--strict", "--target", "es2022", "--module", "nodenext", "--lib", "es2022,dom,dom.iterable", "--types", "node", `${name}.ts`);
  return JSON.parse(execFileSync(process.execPath, [`${name}.js`, museum.url, museum.models.bust.id], { cwd: folder, encoding: "utf8" }));
}

test("Redocly finds no fault", () => {
  const { totals } = JSON.parse(run("redocly", "lint", "openapi.json", "--extends", "recommended", "--format", "json"));
  assert.deepEqual({ errors: totals.errors, warnings: totals.warnings }, { errors: 0, warnings: 0 });
});

test("Spectral finds no fault", () => {
  run("spectral", "lint", "openapi.json", "--ruleset", "spectral.yaml", "--fail-severity", "hint");
});

test("a client with the types of openapi-typescript compiles and calls the daemon", () => {
  run("openapi-typescript", "openapi.json", "--output", "openapi.d.ts");
  assert.deepEqual(compiledAndRun("openapi-fetch"), { title: "bust", problem: "Not Found", status: 404 });
});

test("a client made by orval compiles and calls the daemon", () => {
  run("orval", "--input", "openapi.json", "--output", "orval-client.ts", "--client", "fetch", "--mode", "single");
  assert.deepEqual(compiledAndRun("orval"), { title: "bust", status: 404 });
});
