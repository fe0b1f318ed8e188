// SPDX-License-Identifier: Apache-2.0
// Finds and runs programs from Debian's packages. Tests that need a missing program are skipped; they
// fail if VITRINE_NO_SKIPS is set.
import { execFileSync, spawnSync } from "node:child_process";

/**
 * Returns the options of tests that run the programs `names`. The tests are skipped if a program is missing; they fail instead if
 * VITRINE_NO_SKIPS is set.
 */
export function needs(...names) {
  const missing = names.filter((name) => spawnSync("sh", ["-c", `command -v ${name}`]).status !== 0);
  if (missing.length === 0) return {};
  const reason = `there is no ${missing.join(", no ")}; run deploy/setup full`;
  if (process.env.VITRINE_NO_SKIPS) throw new Error(reason);
  return { skip: reason };
}

export function run(program, ...args) {
  return execFileSync(program, args, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"], maxBuffer: 64 << 20 });
}
