// SPDX-License-Identifier: Apache-2.0
// Two simulated scanners by one name, with one object: what either is told shows which of two daemons drives
// "the" scanner. Their calibrations are in one folder. The first is that of run.sh. To be imported before what starts programs, which are not to meet it.
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

  /** {at, text} of all that its board was told; `at` in ms since 1970. */
  async commands() {
    const text = await readFile(this.record, "utf8");
    return [...text.matchAll(/^(\d+) (.*)$/gm)].map(([, at, command]) => ({ at: Number(at), text: command }));
  }

  async end() {
    this.process?.stdin.end();
    if (this.process) await once(this.process, "close");
  }
}

/** Each with the `env` in which a program meets it. */
export async function startRigs(bin) {
  const first = Object.assign(new Rig("first"), { env: { UMOCKDEV_DIR, LD_PRELOAD } }), second = new Rig("second");
  second.process = spawn(join(bin, "vitrine-rig"), ["--mesh", VITRINE_OBJECT, "--address", "127.0.0.2", "--write-config", second.config,
    "--write-commands", second.record, "--", "sh", "-c", 'echo "$UMOCKDEV_DIR"; exec env -u UMOCKDEV_DIR cat'], { stdio: ["pipe", "pipe", "inherit"] });
  const { value, done } = await createInterface({ input: second.process.stdout })[Symbol.asyncIterator]().next();
  if (done) throw new Error("the second rig does not start");
  second.env = { UMOCKDEV_DIR: value, LD_PRELOAD };
  return [first, second];
}
