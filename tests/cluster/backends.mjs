// SPDX-License-Identifier: Apache-2.0
// Runs a cluster's PostgreSQL server and Ceph gateway with scripts of tests/support/process.
// Creates the cluster's database and bucket in them.
import { execFile, spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";

const run = promisify(execFile);

/**
 * A server that a script of tests/support/process runs. The script first prints the port. Then it prints one line for
 * each command that it receives.
 */
class Backend {
  async start(script) {
    this.folder = await mkdtemp(join(tmpdir(), "vitrine-backend-"));
    const path = fileURLToPath(new URL(`../support/process/${script}`, import.meta.url));
    this.process = spawn(path, [this.folder], { stdio: ["pipe", "pipe", "inherit"] });
    this.lines = createInterface({ input: this.process.stdout })[Symbol.asyncIterator]();
    this.port = await this.#line();
  }

  async ask(command) {
    this.process.stdin.write(`${command}\n`);
    await this.#line();
  }

  async #line() {
    const { value, done } = await this.lines.next();
    if (done) throw new Error("a backend does not start; run deploy/setup test");
    return value;
  }

  async end() {
    this.process.stdin.end();
    await once(this.process, "close");
    await rm(this.folder, { recursive: true, force: true });
  }
}

export class Postgres extends Backend {
  async start() {
    await super.start("postgres.sh");
    await this.ask("create museum");
    this.url = `postgresql://museum:a-secret@127.0.0.1:${this.port}/museum`;
  }

  /** Returns the rows of a query's result, each a list of strings. */
  async query(sql) {
    const { stdout } = await run("/usr/lib/postgresql/15/bin/psql", [this.url, "-XAtq", "-F", "\t", "-c", sql]);
    return stdout.split("\n").filter((line) => line !== "").map((line) => line.split("\t"));
  }
}

export class Gateway extends Backend {
  static keys = { access: "museum", secret: "the-secret-of-the-museum" };

  async start() {
    await super.start("ceph_gateway.sh");
    this.url = `s3://models?endpoint=http://127.0.0.1:${this.port}`;
    await this.#bucket("PUT", "");
  }

  async #bucket(method, query) {
    const { access, secret } = Gateway.keys;
    const words = ["-fsS", "-X", method, "--aws-sigv4", "aws:amz:default:s3", "--user", `${access}:${secret}`];
    const url = `http://127.0.0.1:${this.port}/models${query}`;
    return (await run("curl", [...words, "-H", "x-amz-content-sha256: UNSIGNED-PAYLOAD", url])).stdout;
  }

  /** Returns the SHA-256 of each stored object. Lists at most 1,000 objects. */
  async objects() {
    const listed = await this.#bucket("GET", "?list-type=2&prefix=objects%2F");
    return [...listed.matchAll(/<Key>objects\/([0-9a-f/]+)<\/Key>/g)].map(([, key]) => key.replaceAll("/", ""));
  }
}

/** Returns the text of a configuration file for daemons that share the back ends, and the uploads in `folder`. */
export function sharedSettings(folder, postgres, gateway) {
  const { access, secret } = Gateway.keys;
  return `data = ${folder}/command
uploads = ${folder}/uploads
store = ${gateway.url}
store-access-key = ${access}
store-secret-key = ${secret}
catalogue = ${postgres.url}
request-rate = 0
max-connections-per-address = 0
`;
}
