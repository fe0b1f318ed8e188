// SPDX-License-Identifier: Apache-2.0
// Records the SQL statements that a release sends to its catalogue, for the tests of later releases:
// node record.mjs BINARIES MESH >VERSION.json
// The release's vitrined starts on an empty database and executes the requests of an operator, except those for
// scanners. The database server's log is converted to a list of transactions, each of which is a list of {sql, values}.
import { execFile, spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { Daemon } from "../../e2e/daemon.mjs";

const [bin, mesh] = process.argv.slice(2);
const folder = await mkdtemp(join(tmpdir(), "vitrine-record-"));
const script = fileURLToPath(new URL("../../support/process/postgres.sh", import.meta.url));
const server = spawn(script, [folder], { stdio: ["pipe", "pipe", "inherit"] });
const lines = createInterface({ input: server.stdout })[Symbol.asyncIterator]();
const { value: port } = await lines.next();
server.stdin.write("create old\n");
await lines.next();
const url = `postgresql://museum:a-secret@127.0.0.1:${port}/old?options=-c%20log_statement%3Dall%20-c%20bytea_output%3Dhex`;

/** Sends an operator's requests, one after the other. */
async function operate(daemon, conf) {
  const vitrine = async (...words) => JSON.parse((await promisify(execFile)(join(bin, "vitrine"), [...words, "--json"])).stdout);
  const { token } = await vitrine("token", "create", "--role", "admin", "--data", conf);
  const ask = async (method, path, body, headers = {}) => {
    const fields = { Authorization: `Bearer ${token}`, ...(body && { "Content-Type": "application/json" }), ...headers };
    const answer = await fetch(`${daemon.url}/api/v1${path}`, { method, headers: fields, ...(body && { body: JSON.stringify(body) }) });
    return { status: answer.status, body: await answer.json().catch(() => undefined) };
  };
  const publish = (title) => vitrine("publish", mesh, "--server", daemon.url, "--token", token, "--title", title);
  const [first, second, third] = [await publish("First"), await publish("Second"), await publish("Third")];
  await ask("PATCH", `/models/${first.id}`, { title: "Bust", creator: "somebody", accuracy: 0.1 });
  await ask("PATCH", `/models/${first.id}`, { public_max_level: 4 });
  await ask("POST", `/models/${second.id}/unpublish`);
  await ask("POST", `/models/${second.id}/publish`);
  await ask("DELETE", `/models/${third.id}`);
  for (const path of [`/models/${first.id}`, `/models/${first.id}/manifest`, "/models?limit=1", "/models?q=bust", "/models?drafts=true", "/jobs", "/scans"])
    await ask("GET", path);
  const { chunks } = (await ask("GET", `/models/${second.id}/manifest`)).body;
  await ask("GET", `/chunks/${chunks[0].sha256}`);
  const made = await ask("POST", "/tokens", { role: "viewer", label: "a label" });
  await ask("GET", "/tokens");
  await ask("DELETE", `/tokens/${made.body.id}`);
  const refused = { upload: "00000000000000000000000000", publish: true };
  await ask("POST", "/models", refused, { "Idempotency-Key": "once" });
}

/** Returns the transactions in the database server's log, in the order in which they ended. */
function transactions(log) {
  const open = new Map(), done = [];
  const entry = /^\S+ \S+ \S+ \[(\d+)\] (LOG|DETAIL): {2}(statement|execute [^:]*|parameters): ([^]*?)(?=\n\S+ \S+ \S+ \[\d+\] |$(?![^]))/gm;
  for (const [, connection, , what, text] of log.matchAll(entry)) {
    const said = text.replaceAll("\n\t", "\n");
    const list = open.get(connection) ?? [];
    if (what === "parameters") {
      list.last.values = [...said.matchAll(/\$\d+ = (?:NULL|'((?:[^']|'')*)')/g)].map(([, value]) => value?.replaceAll("''", "'") ?? null);
      continue;
    }
    list.push((list.last = { sql: said, values: [] }));
    open.set(connection, list);
    if (list[0].sql === "BEGIN" && !/^(COMMIT|ROLLBACK)$/.test(said)) continue;
    done.push(list);
    open.set(connection, Object.assign([], { last: list.last }));
  }
  return done;
}

const daemon = await Daemon.start(bin, ["--catalogue", url]);
const conf = join(folder, "vitrine.conf");
await writeFile(conf, `data = ${daemon.data}\ncatalogue = ${url}\n`);
await operate(daemon, conf);
await daemon.stop();
server.stdin.end();
await once(server, "close");
const all = transactions(await readFile(join(folder, "log"), "utf8"));
// Transactions that only read are recorded once, even if they occurred repeatedly.
const texts = all.map((transaction) => JSON.stringify(transaction));
const told = all.filter((_, i) => texts.indexOf(texts[i]) === i || !texts[i].startsWith('[{"sql":"SELECT'));
process.stdout.write(`[\n${told.map((transaction) => JSON.stringify(transaction)).join(",\n")}\n]\n`);
await rm(folder, { recursive: true, force: true });
