// SPDX-License-Identifier: Apache-2.0
// Two simulated scanners with the same name and object, for two daemons. Each scanner belongs to one daemon, so the
// commands to a scanner show when its daemon drives it. The scanners share a folder of calibrations. run.sh starts the
// first one. Import this module before any program is started, so that no program inherits the first scanner's
// environment.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { createInterface } from "node:readline";

const { UMOCKDEV_DIR, LD_PRELOAD, VITRINE_RIG, VITRINE_OBJECT } = process.env;
delete process.env.UMOCKDEV_DIR;
delete process.env.LD_PRELOAD;

class Rig {
  constructor(name) {
    [this.config, this.record] = [`${name}.json`, `${name}.commands`].map((file) => join(VITRINE_RIG, file));
  }

  /** Returns all commands to the scanner's board as {at, text}; `at` is in ms since 1970. */
  async commands() {
    const text = await readFile(this.record, "utf8");
    return [...text.matchAll(/^(\d+) (.*)$/gm)].map(([, at, command]) => ({ at: Number(at), text: command }));
  }

  async end() {
    this.process?.stdin.end();
    if (this.process) await once(this.process, "close");
  }
}

export const firstRig = Object.assign(new Rig("first"), { env: { UMOCKDEV_DIR, LD_PRELOAD } });

/**
 * Starts the second scanner and returns both. A program finds a scanner if it runs with that scanner's environment
 * `env`.
 */
export async function startRigs(bin) {
  const second = new Rig("second");
  second.process = spawn(join(bin, "vitrine-rig"), ["--mesh", VITRINE_OBJECT, "--address", "127.0.0.2", "--write-config", second.config,
    "--write-commands", second.record, "--", "sh", "-c", 'echo "$UMOCKDEV_DIR"; exec env -u UMOCKDEV_DIR cat'], { stdio: ["pipe", "pipe", "inherit"] });
  const { value, done } = await createInterface({ input: second.process.stdout })[Symbol.asyncIterator]().next();
  if (done) throw new Error("the second rig does not start");
  second.env = { UMOCKDEV_DIR: value, LD_PRELOAD };
  return [firstRig, second];
}
