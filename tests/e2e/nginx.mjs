// SPDX-License-Identifier: Apache-2.0
// Runs nginx with the shipped configuration (deploy/nginx/vitrine.conf) for the duration of a test.
import { execFile, execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { chmod, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { createConnection, createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { promisify } from "node:util";

const kProgram = "/usr/sbin/nginx";
const kShipped = new URL("../../deploy/nginx/vitrine.conf", import.meta.url);

export class Nginx {
  /**
   * Starts nginx in front of the daemons at `origins`, each given as "127.0.0.1:PORT". The last
   * daemon has the scanner. `changes` are pairs [old, new] of texts to replace in the
   * configuration. nginx receives PURGE requests at `purgePort`.
   */
  static async start(origins, changes = [], purgePort = undefined) {
    const nginx = new Nginx();
    nginx.folder = await mkdtemp(join(tmpdir(), "vitrine-nginx-"));
    // Lets nginx's worker processes read the folder. They run as another user.
    await chmod(nginx.folder, 0o755);
    nginx.port = await freePort();
    nginx.plainPort = await freePort();
    nginx.url = `https://localhost:${nginx.port}`;
    await nginx.#configure(origins, changes, purgePort ?? await freePort());
    await promisify(execFile)(kProgram, [...nginx.#words(), "-t"]);
    await nginx.#begin();
    return nginx;
  }

  #words() {
    return ["-p", this.folder, "-c", "nginx.conf", "-e", "error.log"];
  }

  async #begin() {
    this.child = spawn(kProgram, this.#words(), { stdio: "ignore" });
    this.exit = once(this.child, "close");
    await listens(this.port);
  }

  async #configure(origins, changes, purge) {
    const path = (name) => join(this.folder, name);
    this.certificate = path("cert.pem");
    this.cache = path("cache");
    this.purgeUrl = `http://127.0.0.1:${purge}`;
    execFileSync("openssl", ["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "90", "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost", "-keyout", path("key.pem"), "-out", this.certificate], { stdio: "ignore" });
    await writeFile(path("nginx.conf"), `daemon off; worker_processes 1; pid nginx.pid; events { worker_connections 1024; }
http { access_log off; client_body_temp_path body; proxy_temp_path proxy; fastcgi_temp_path fastcgi; uwsgi_temp_path uwsgi; scgi_temp_path scgi;
include site.conf; }\n`);
    await writeFile(path("site.conf"), replaced((await readFile(kShipped, "utf8")).replaceAll("museum.example;", "localhost;"), [
      ["server 127.0.0.1:8080;  # one line per replica", `${origins.map((origin) => `server ${origin};`).join(" ")}  #`],
      ["server 127.0.0.1:8080;  # the replica with the scanner", `server ${origins.at(-1)};`],
      ["/var/cache/nginx/vitrine", this.cache],
      ["/etc/ssl/certs/museum.example.pem", this.certificate],
      ["/etc/ssl/private/museum.example.key", path("key.pem")],
      ["listen 127.0.0.1:8081;", `listen 127.0.0.1:${purge};`],
      ["proxy_pass http://127.0.0.1:8081;", `proxy_pass http://127.0.0.1:${purge};`],
      ...["", " default_server"].flatMap((which) => [
        [`listen 80${which};`, `listen 127.0.0.1:${this.plainPort}${which};`],
        [`listen [::]:80${which};`, ""],
        [`listen 443 ssl http2${which};`, `listen 127.0.0.1:${this.port} ssl http2${which};`],
        [`listen [::]:443 ssl http2${which};`, ""],
      ]),
      ...changes,
    ]));
  }

  /** Reloads the configuration and waits until all old worker processes have ended. The cache stays. */
  async reload() {
    const before = new Set(await this.#children());
    this.child.kill("SIGHUP");
    while ((await this.#children()).some((pid) => before.has(pid)));
  }

  /** Kills all processes of nginx and starts nginx again after `pause` ms. The cache stays. */
  async crash(pause) {
    const children = await this.#children();
    this.child.kill("SIGKILL");
    for (const pid of children) process.kill(Number(pid), "SIGKILL");
    await this.exit;
    await new Promise((resolve) => setTimeout(resolve, pause));
    await this.#begin();
  }

  async #children() {
    return (await readFile(`/proc/${this.child.pid}/task/${this.child.pid}/children`, "utf8")).trim().split(" ");
  }

  async stop() {
    this.child.kill("SIGTERM");
    await this.exit;
    await rm(this.folder, { recursive: true, force: true });
  }
}

/** Replaces texts of the shipped configuration. Throws unless each text occurs exactly once. */
function replaced(text, changes) {
  for (const [from, to] of changes) {
    if (text.split(from).length !== 2) throw new Error(`'${from}' is not once in ${kShipped.pathname}`);
    text = text.replace(from, to);
  }
  return text;
}

/** Returns a free port of 127.0.0.1. */
export async function freePort() {
  const server = createServer().listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = server.address();
  server.close();
  await once(server, "close");
  return port;
}

/** Resolves when a server listens at `port`. Tries again after each refused connection. */
async function listens(port) {
  for (;;) {
    const socket = createConnection(port, "127.0.0.1");
    const open = await new Promise((resolve) => socket.once("connect", () => resolve(true)).once("error", () => resolve(false)));
    socket.destroy();
    if (open) return;
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}
