// SPDX-License-Identifier: Apache-2.0
// Runs a whole installation on this machine: replicas with different roles behind nginx with the shipped configuration.
// They share one PostgreSQL database, one bucket of a Ceph gateway, and a scanner that two replicas may drive.
import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as pause } from "node:timers/promises";
import { promisify } from "node:util";
import { startRigs } from "./rigs.mjs";
import { env } from "../e2e/daemon.mjs";
import { Nginx, freePort } from "../e2e/nginx.mjs";
import { Gateway, Postgres, sharedSettings } from "./backends.mjs";
import { Replica, kRestart } from "./replica.mjs";
import { note } from "./timeline.mjs";
import { Visitor } from "./visitor.mjs";

const kRoles = ["serve", "serve", "serve", "build", "build", "serve,scan", "serve,scan"];
// SQL statements that create tables and triggers, which record changes of the catalogue during the test.
const kHistory = `
  CREATE TABLE published(model BYTEA, file BYTEA);
  CREATE FUNCTION published() RETURNS trigger LANGUAGE plpgsql AS 'BEGIN INSERT INTO published VALUES (NEW.id, NEW.file); RETURN NULL; END';
  CREATE TRIGGER published AFTER INSERT OR UPDATE OF file ON model FOR EACH ROW EXECUTE FUNCTION published();
  CREATE TABLE done(job BYTEA);
  CREATE FUNCTION done() RETURNS trigger LANGUAGE plpgsql AS 'BEGIN INSERT INTO done VALUES (NEW.id); RETURN NULL; END';
  CREATE TRIGGER done AFTER UPDATE ON job FOR EACH ROW WHEN (NEW.state = 3 AND OLD.state != 3) EXECUTE FUNCTION done();
  CREATE TABLE driven(epoch BIGINT, holder TEXT, at BIGINT);
  CREATE FUNCTION driven() RETURNS trigger LANGUAGE plpgsql AS
    'BEGIN INSERT INTO driven VALUES (NEW.epoch, NEW.holder, extract(epoch FROM clock_timestamp()) * 1000); RETURN NULL; END';
  CREATE TRIGGER driven AFTER INSERT OR UPDATE OF epoch ON scanner FOR EACH ROW EXECUTE FUNCTION driven();`;

export class Cluster {
  postgres = new Postgres();
  gateway = new Gateway();
  rigs = [];
  replicas = [];

  constructor(bin) {
    this.bin = bin;
  }

  async start() {
    this.folder = await mkdtemp(join(tmpdir(), "vitrine-cluster-"));
    [this.rigs] = await Promise.all([startRigs(this.bin), this.postgres.start(), this.gateway.start()]);
    await this.#configure();
    const { token } = await this.vitrine("token", "create", "--role", "operator", "--data", this.conf);
    await this.postgres.query(kHistory);
    for (const [number, roles] of kRoles.entries()) this.replicas.push(await this.#replica(roles, number));
    await Promise.all(this.replicas.map((replica) => replica.ready()));
    this.nginx = await Nginx.start(this.having("serve").map(({ port }) => `127.0.0.1:${port}`));
    this.visitor = new Visitor(this.nginx.url, await readFile(this.nginx.certificate), token);
  }

  async #configure() {
    await mkdir(join(this.folder, "uploads"));
    this.conf = join(this.folder, "vitrine.conf");
    await writeFile(this.conf, `${sharedSettings(this.folder, this.postgres, this.gateway)}collect-after = 1
max-uploads = 1000
trusted-proxies = 127.0.0.1
`);
  }

  async #replica(roles, number) {
    const folder = join(this.folder, `${number}`), port = await freePort();
    await mkdir(folder);
    const words = ["--config", this.conf, "--roles", roles], rig = roles.includes("scan") ? this.rigs[this.having("scan").length] : undefined;
    if (rig) words.push("--scanners", rig.config, "--scan-address", `http://127.0.0.1:${port}`);
    return Object.assign(new Replica(`${roles} ${number}`, this.bin, folder, port, words, rig?.env), { rig });
  }

  /** Returns the replicas whose list of roles ends with `role`. */
  having(role) {
    return this.replicas.filter(({ name }) => name.split(" ")[0].split(",").at(-1) === role);
  }

  /** Waits until the result of `sql` contains the identity of a replica with `role`, and returns that replica. */
  async #heldBy(role, sql) {
    for (;; await pause(20)) {
      const holders = (await this.postgres.query(sql)).flat();
      for (const replica of this.having(role)) if (holders.includes(await replica.holder())) return replica;
    }
  }

  /** Waits for a replica that is running a job, and returns that replica. */
  builder() {
    return this.#heldBy("build", "SELECT holder FROM job WHERE state = 1 AND kind = 3");
  }

  /** Kills nginx and starts it again, as systemd would. */
  async nginxCrashes() {
    note("SIGKILL to nginx");
    await this.nginx.crash(kRestart);
  }

  /** Waits for a replica that drives the scanner, and returns that replica. */
  driver() {
    return this.#heldBy("scan", "SELECT holder FROM scanner");
  }

  async vitrine(...words) {
    const { stdout } = await promisify(execFile)(join(this.bin, "vitrine"), [...words, "--json"], { env });
    return JSON.parse(stdout);
  }

  /** Returns the last 15 warnings and errors in the log of each replica. */
  logs() {
    const lines = ({ name, log }) => log.split("\n").filter((line) => /event=(warning|error|critical)/.test(line)).slice(-15).map((line) => `${name}: ${line}`);
    return this.replicas.flatMap(lines).join("\n");
  }

  async end() {
    this.visitor?.close();
    await Promise.all(this.replicas.map((replica) => replica.end()));
    await this.nginx?.stop();
    await Promise.all([this.postgres.end(), this.gateway.end(), ...this.rigs.map((rig) => rig.end())]);
    await rm(this.folder, { recursive: true, force: true });
  }
}
