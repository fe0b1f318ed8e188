// SPDX-License-Identifier: Apache-2.0
// The daemon with the simulated scanner beside it, both on a loopback of their own: a camera's port is
// fixed, and tests run side by side. A socket leads out of there, and the browser is led to it.
import { once } from "node:events";
import { connect, createServer } from "node:net";
import { join } from "node:path";
import { pipeline } from "node:stream";
import { Daemon } from "./daemon.mjs";

export class DaemonAtRig extends Daemon {
  /** `options` of the rig, such as --mesh FILE. */
  static async start(folderOfBinaries, options) {
    const daemon = await super.start(folderOfBinaries, options);
    daemon.door = createServer((visitor) => pipeline(visitor, connect(daemon.socket), visitor, () => undefined)).listen(0, "127.0.0.1");
    await once(daemon.door, "listening");
    daemon.url = `http://127.0.0.1:${daemon.door.address().port}`;
    return daemon;
  }

  get socket() {
    return join(this.folder, "socket");
  }

  command([listen, , ...words]) {
    const config = join(this.folder, "rig.json");
    const rig = [join(this.bin, "vitrine-rig"), ...this.options, "--private-network", "--write-config", config, "--"];
    return [...rig, join(this.bin, "vitrined"), listen, `unix:${this.socket}`, ...words, "--scanners", config];
  }

  async stop() {
    this.door.close();
    await super.stop();
  }
}
