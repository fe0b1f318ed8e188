// SPDX-License-Identifier: Apache-2.0
// Tests `vitrine doctor` with the real daemon, directly and behind faulty proxies.
// Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file).
import assert from "node:assert/strict";
import { execFile, execFileSync } from "node:child_process";
import { once } from "node:events";
import { chmod, mkdtemp, readdir, readFile, rm, writeFile } from "node:fs/promises";
import http from "node:http";
import https from "node:https";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { Daemon } from "./daemon.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan } = process.env;
let daemon, folder;

before(async () => {
  daemon = await Daemon.start(bin);
  await daemon.publish(scan, "Demosthenes");
  folder = await mkdtemp(join(tmpdir(), "vitrine-"));
});

after(async () => {
  await daemon?.stop();
  await rm(folder, { recursive: true, force: true });
});

/** Runs `vitrine doctor`. Returns the exit code, and the findings by the names of the checks. */
function doctor(...words) {
  return new Promise((resolve) => {
    execFile(join(bin, "vitrine"), ["doctor", "--json", ...words], (fault, stdout, stderr) => {
      const report = JSON.parse(stdout || "null");
      resolve({ code: fault?.code ?? 0, stderr, report, by: Object.fromEntries(report?.checks.map((c) => [c.check, c]) ?? []) });
    });
  });
}

/**
 * Calls `examine` with the URL of a faulty proxy in front of the daemon. The proxy refuses upgrades and removes the
 * request headers listed in `spoil.drops`. The function `spoil.fields` may change the response headers.
 */
async function proxied(spoil, examine) {
  const proxy = http.createServer((request, response) => {
    const { method, url, headers } = request;
    for (const name of ["connection", "upgrade", ...(spoil.drops ?? [])]) delete headers[name];
    http.request(daemon.url + url, { method, headers }, (answer) => {
      spoil.fields?.(answer.headers);
      response.writeHead(answer.statusCode, answer.headers);
      answer.pipe(response);
    }).end();
  });
  proxy.listen(0, "127.0.0.1");
  await once(proxy, "listening");
  try {
    await examine(`http://127.0.0.1:${proxy.address().port}`);
  } finally {
    proxy.closeAllConnections();
    proxy.close();
  }
}

test("a daemon by itself serves well", async () => {
  const { code, by, report } = await doctor("--url", `${daemon.url}/`);
  assert.equal(code, 0, JSON.stringify(report));
  for (const check of ["server", "certificate", "server clock", "cors", "etag", "range", "caching", "websocket"])
    assert.equal(by[check]?.verdict, "ok", check);
});

test("a proxy without upgrades is found out, and what to write into it", async () => {
  await proxied({}, async (url) => {
    const { code, by, stderr } = await doctor("--url", url);
    assert.equal(code, 1);
    assert.equal(by.websocket.verdict, "fail");
    assert.match(by.websocket.advice, /Upgrade/);
    assert.match(stderr, /^vitrine: 1 of \d+ checks failed; /);
    for (const check of ["cors", "etag", "range", "caching"]) assert.equal(by[check].verdict, "ok", check);
  });
});

test("a proxy that drops fields is found out", async () => {
  const fields = (headers) => {
    delete headers["access-control-allow-origin"];
    if (headers.etag) headers.etag = `W/${headers.etag}`;
    headers["cache-control"] = "no-cache";
  };
  await proxied({ fields, drops: ["range"] }, async (url) => {
    const { by } = await doctor("--url", url);
    assert.equal(by.cors.verdict, "fail");
    for (const check of ["etag", "caching", "range"]) {
      assert.equal(by[check].verdict, "warn", check);
      assert.ok(by[check].advice, check);
    }
  });
});

test("a clock that is wrong is found out", async () => {
  const fields = (headers) => (headers.date = new Date(Date.now() - 3_600_000).toUTCString());
  await proxied({ fields }, async (url) => {
    const { by } = await doctor("--url", url);
    assert.equal(by["server clock"].verdict, "warn");
    assert.match(by["server clock"].detail, /^36\d\d s from/);
    assert.match(by["server clock"].advice, /synchronise/);
  });
});

test("a certificate that nobody trusts is named", async () => {
  const key = join(folder, "key.pem"), cert = join(folder, "cert.pem");
  execFileSync("openssl", ["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "10", "-subj", "/CN=127.0.0.1", "-keyout", key, "-out", cert], { stdio: "ignore" });
  const server = https.createServer({ key: await readFile(key), cert: await readFile(cert) });
  server.listen(0, "127.0.0.1");
  await once(server, "listening");
  const { code, by } = await doctor("--url", `https://127.0.0.1:${server.address().port}`);
  server.close();
  assert.equal(code, 1);
  assert.match(by.server.detail, /certificate/i);
});

test("nobody at the address is a failure with a next step", async () => {
  const { code, by } = await doctor("--url", "http://127.0.0.1:1");
  assert.equal(code, 1);
  assert.equal(by.server.verdict, "fail");
  assert.ok(by.server.advice);
});

test("a data folder is looked at and left as it was", async () => {
  await chmod(daemon.data, 0o755);
  const names = async () => (await readdir(daemon.data)).sort();
  const files = await names();
  const open = await doctor("--data", daemon.data);
  assert.equal(open.by.permissions.verdict, "warn");
  assert.match(open.by.permissions.advice, /chmod o-rwx/);
  await chmod(daemon.data, 0o700);
  const closed = await doctor("--data", daemon.data);
  assert.equal(closed.by.permissions.verdict, "ok");
  assert.equal(closed.by.catalogue.verdict, "ok");
  assert.match(closed.by.catalogue.detail, /^1 models/);
  assert.ok(closed.by.disk && closed.by.clock && closed.by["open files"]);
  assert.deepEqual(await names(), files);
});

test("a model whose file is damaged is named", async () => {
  const data = join(folder, "data");
  const words = ["publish", scan, "--data", data, "--json"];
  execFileSync("mkdir", [data]);
  const { id } = JSON.parse(execFileSync(join(bin, "vitrine"), words, { stdio: ["ignore", "pipe", "ignore"] }));
  const [object] = (await readdir(join(data, "objects"), { recursive: true })).filter((name) => /[0-9a-f]{64}$/.test(name));
  await chmod(join(data, "objects", object), 0o600);
  await writeFile(join(data, "objects", object), "short");
  const { code, by } = await doctor("--data", data);
  assert.equal(code, 1);
  assert.ok(by.catalogue.detail.includes(id));
});

test("no folder, no installation", async () => {
  assert.equal((await doctor("--data", join(folder, "nothing"))).by.permissions.verdict, "fail");
  assert.equal((await doctor("--data", folder)).by.catalogue.verdict, "fail");
});
