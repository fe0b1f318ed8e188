// SPDX-License-Identifier: Apache-2.0
// A vitrined process of a test cluster. It is restarted whenever it dies, as under systemd.
import { readFile, rm } from "node:fs/promises";
import { join } from "node:path";
import { setTimeout as pause } from "node:timers/promises";
import { Daemon } from "../e2e/daemon.mjs";
import { note } from "./timeline.mjs";

export const kRestart = 100; // ms until a dead daemon is restarted

export class Replica extends Daemon {
  /** Starts the daemon in `folder`. `options` are added to its command line, `variables` to its environment. */
  constructor(name, bin, folder, port, options, variables) {
    super(bin, folder, join(folder, "data"), options);
    Object.assign(this, { name, port, url: `http://127.0.0.1:${port}`, ending: false });
    Object.assign(this.env, variables);
    this.begin();
  }

  begin() {
    this.spawn(`127.0.0.1:${this.port}`, join(this.folder, "port"));
    this.exit.then(async (code) => {
      note(`${this.name} has ended with ${code}`);
      await pause(kRestart);
      if (!this.ending) this.begin();
    });
  }

  async ready() {
    while (!(await this.isReady())) {
      if (this.ending) throw new Error(`${this.name} has ended: ${this.log}`);
      await pause(50);
    }
    note(`${this.name} is ready`);
  }

  async isReady() {
    this.adminPort = Number(await readFile(join(this.folder, "admin-port"), "utf8").catch(() => "0"));
    const answer = await fetch(`http://127.0.0.1:${this.adminPort}/readyz`).catch(() => undefined);
    return answer?.status === 200;
  }

  /** Kills the daemon. Returns when the daemon has been restarted and is ready. */
  async crash() {
    await rm(join(this.folder, "admin-port"), { force: true });
    this.signal("SIGKILL");
    await this.ready();
  }

  signal(name) {
    note(`${name} to ${this.name}`);
    this.child.kill(name);
  }

  /** Returns the identity under which the daemon holds leases in the catalogue. */
  async holder() {
    return (await readFile(join(this.data, "daemon.lock"), "utf8")).split(" ")[0];
  }

  async end() {
    this.ending = true;
    this.signal("SIGTERM");
    return this.exit;
  }
}
