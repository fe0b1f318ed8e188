// SPDX-License-Identifier: Apache-2.0
// Runs the daemon with the simulated scanner in a private network namespace. The camera's port is
// fixed, so tests that run in parallel need separate namespaces. The daemon listens on a Unix
// socket, to which a TCP port forwards the browser's connections.
import { once } from "node:events";
import { connect, createServer } from "node:net";
import { join } from "node:path";
import { pipeline } from "node:stream";
import { Daemon } from "./daemon.mjs";

export class DaemonAtRig extends Daemon {
  /** Starts the daemon. `options` are command-line options of vitrine-rig, such as --mesh FILE. */
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
