// SPDX-License-Identifier: Apache-2.0
// Runs the shipped binaries with a temporary data folder for the duration of a test.
import { execFile, spawn } from "node:child_process";
import { once } from "node:events";
import { watch } from "node:fs";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { promisify } from "node:util";

const run = promisify(execFile);
// The environment without the VITRINE_ variables of this test, because the daemon refuses settings
// that it does not know.
export const env = Object.fromEntries(Object.entries(process.env).filter(([name]) => !name.startsWith("VITRINE_")));

// Matches log lines that report a fault of the daemon or of its C++ runtime.
const kFault = /event=(error|critical)|terminate called|Sanitizer/;

export class Daemon {
  /** Starts a daemon. `options` are appended to its command line. Subclasses may pass them to another program. */
  static async start(folderOfBinaries, options = []) {
    const bin = resolve(folderOfBinaries);
    const folder = await mkdtemp(join(tmpdir(), "vitrine-"));
    const portFile = join(folder, "port");
    const appeared = Promise.all([watched(folder, portFile), watched(folder, join(folder, "admin-port"))]);
    const data = join(folder, "data");
    const daemon = new this(bin, folder, data, options);
    const ended = daemon.spawn("127.0.0.1:0", portFile);
    [daemon.port, daemon.adminPort] = await Promise.race([appeared, ended]);
    daemon.url = `http://127.0.0.1:${daemon.port}`;
    return daemon;
  }

  constructor(bin, folder, data, options) {
    Object.assign(this, { bin, folder, data, options, env: { ...env }, log: "" });
  }

  /** Returns the command line that runs the daemon with the arguments `words`. */
  command(words) {
    return [join(this.bin, "vitrined"), ...words, ...this.options];
  }

  /** Starts the program. Returns a promise that rejects when the program ends. */
  spawn(listen, portFile) {
    const words = ["--listen", listen, "--admin-listen", "127.0.0.1:0", "--data", this.data, "--port-file", portFile,
                   "--admin-port-file", join(this.folder, "admin-port")];
    const [program, ...rest] = this.command(words);
    this.child = spawn(program, rest, { cwd: this.folder, env: this.env, stdio: ["ignore", "ignore", "pipe"] });
    this.child.stderr.on("data", (text) => (this.log += text));
    this.exit = once(this.child, "close").then(([code, signal]) => code ?? signal);
    const ended = this.exit.then((code) => Promise.reject(new Error(`vitrined ended with ${code}: ${this.log}`)));
    ended.catch(() => undefined);
    return ended;
  }

  /** Kills the daemon abruptly, as a power failure would, and restarts it at the same address. */
  async killAndStartAgain() {
    await this.kill();
    await this.startAgain();
  }

  async kill() {
    this.child.kill("SIGKILL");
    await this.exit;
  }

  /** Restarts the daemon at the same address. */
  async startAgain() {
    const portFile = join(this.folder, "port-again");
    const appeared = watched(this.folder, portFile);
    await Promise.race([appeared, this.spawn(`127.0.0.1:${this.port}`, portFile)]);
  }

  /** Returns the samples of /metrics as a list of [name, labels, value]. */
  async metrics() {
    const text = await (await fetch(`http://127.0.0.1:${this.adminPort}/metrics`)).text();
    return [...text.matchAll(/^([a-z_]+)(\{.*\})? (\S+)$/gm)].map(([, name, labels, value]) => [name, labels ?? "", Number(value)]);
  }

  /** Returns the number of requests for chunks that the daemon has counted. */
  async chunkRequests() {
    const counted = (await this.metrics()).filter(([name, labels]) => name === "vitrine_http_requests_total" && labels.includes('"/api/v1/chunks/'));
    return counted.reduce((sum, [, , value]) => sum + value, 0);
  }

  /** Publishes a mesh; `more` are further arguments of the command. Returns the URL of the model's page. */
  async publish(mesh, title, ...more) {
    const { stdout } = await run(join(this.bin, "vitrine"), ["publish", mesh, "--data", this.data, "--title", title, "--json", ...more], { env });
    return `${this.url}/models/${JSON.parse(stdout).id}`;
  }

  /** Stops the daemon with SIGTERM. Fails unless the exit code is 0 and the log has no faults. */
  async stop() {
    this.child.kill("SIGTERM");
    const code = await this.exit;
    await rm(this.folder, { recursive: true, force: true });
    if (code !== 0) throw new Error(`vitrined ended with ${code}`);
    const faults = this.log.split("\n").filter((line) => kFault.test(line));
    if (faults.length > 0) throw new Error(`in the log of vitrined:\n${faults.join("\n")}`);
  }
}

/** Resolves to the content of `file` once the file exists. The file must be written atomically. */
function watched(folder, file) {
  return new Promise((resolve) => {
    const watcher = watch(folder, async () => {
      const text = await readFile(file, "utf8").catch(() => "");
      if (text.trim() === "") return;
      watcher.close();
      resolve(Number(text));
    });
  });
}
