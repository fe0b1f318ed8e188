// SPDX-License-Identifier: Apache-2.0
// Tests the element on every kind of web host that the product supports. The element must load
// nothing from other servers.
import assert from "node:assert/strict";
import { execFile, spawn } from "node:child_process";
import { once } from "node:events";
import { mkdir, writeFile } from "node:fs/promises";
import { createServer } from "node:net";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { promisify } from "node:util";
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";
import { writeBlob } from "./models.mjs";
import { StaticHost } from "./static_host.mjs";

const { VITRINE_BIN: bin } = process.env;

let daemon, browser, api, faces, nginx;
const hosts = {};

before(async () => {
  daemon = await Daemon.start(bin);
  browser = await launch();
  const mesh = join(daemon.folder, "blob.ply");
  await writeBlob(mesh, 60);
  api = (await daemon.publish(mesh, "A model that is more than its first request")).replace("/models/", "/api/v1/models/");
  faces = (await (await fetch(`${api}/manifest`)).json()).levels.at(-1).faces;
  const file = Buffer.from(await (await fetch(`${api}/file.pmesh`)).arrayBuffer());
  Object.assign(hosts, {
    page: await StaticHost.start(), whole: await StaticHost.start({ range: false }), other: await StaticHost.start({ cors: true }),
  });
  for (const host of Object.values(hosts)) host.add("model.pmesh", file);
  nginx = await Nginx.start(daemon);
});

after(async () => {
  await browser?.close();
  await nginx?.stop();
  for (const host of Object.values(hosts)) host.stop();
  await daemon?.stop();
});

/**
 * The kinds of hosts. Each function returns the viewer's attributes, and `chunks`, which is true if
 * the viewer must request the daemon's chunk URLs. `page` is the static host that serves the page;
 * the default is `hosts.page`.
 */
const kHosts = {
  "the daemon by WebSocket": () => ({ src: api, transport: "ws", chunks: false }),
  "the daemon by plain HTTP": () => ({ src: api, transport: "http", chunks: true }),
  "nginx with a body cap of 100 MB before the daemon": () => ({ src: api.replace(daemon.url, nginx.url), chunks: true }),
  "nginx before the daemon, by WebSocket": () => ({ src: api.replace(daemon.url, nginx.url), transport: "ws", chunks: false }),
  "a static host with Range": () => ({ src: `${hosts.page.url}/model.pmesh`, chunks: false }),
  "a static host without Range": () => ({ src: `${hosts.whole.url}/model.pmesh`, page: hosts.whole, chunks: false }),
  "a static host of another origin": () => ({ src: `${hosts.other.url}/model.pmesh`, chunks: false }),
};

describe("shows every triangle from", () => {
  for (const [name, host] of Object.entries(kHosts)) {
    test(name, async () => {
      const { chunks, page = hosts.page, ...attributes } = host();
      const viewer = await ViewerPage.open(browser, page.page({ "pixel-error": 0, ...attributes }));
      viewer.holding = false;
      await viewer.events("load");
      assert.equal(await viewer.triangles(), faces);
      assert.equal(viewer.askedChunks > 0, chunks);
      assert.deepEqual(viewer.origins.filter((origin) => !origin.includes("//127.0.0.1:")), [], "nothing comes from elsewhere");
      assert.deepEqual(await viewer.complaints(), []);
      await viewer.page.context().close();
    });
  }
});

test("a host with Range is asked for parts, one without for the whole once", async () => {
  const models = (host) => host.asked.filter((line) => line.includes("/model.pmesh"));
  assert.ok(models(hosts.page).length > 1);
  assert.ok(models(hosts.page).every((line) => line.includes("bytes=")));
  assert.equal(models(hosts.whole).length, 1);
});

/**
 * An nginx in front of a daemon, configured like those of many museums: it limits the size of
 * uploads and forwards WebSocket upgrades.
 */
class Nginx {
  static async start({ folder, port: upstream }) {
    const port = await freePort();
    const home = join(folder, "nginx");
    await mkdir(home, { recursive: true });
    await writeFile(join(home, "nginx.conf"), `
      daemon off; worker_processes 1; pid nginx.pid; error_log stderr warn;
      events {}
      http {
        access_log off; client_max_body_size 100m;
        client_body_temp_path body; proxy_temp_path proxy; fastcgi_temp_path f; uwsgi_temp_path u; scgi_temp_path s;
        map $http_upgrade $upgrade { default upgrade; "" ""; }
        server { listen 127.0.0.1:${port};
          location / { proxy_pass http://127.0.0.1:${upstream}; proxy_http_version 1.1;
            proxy_set_header Host $http_host; proxy_set_header Upgrade $http_upgrade; proxy_set_header Connection $upgrade; } } }`);
    const proxy = new Nginx();
    proxy.url = `http://127.0.0.1:${port}`;
    await promisify(execFile)("nginx", ["-t", "-q", "-p", home, "-c", "nginx.conf"]);
    proxy.child = spawn("nginx", ["-p", home, "-c", "nginx.conf"], { stdio: "ignore" });
    while (!(await fetch(`${proxy.url}/`).catch(() => undefined)));
    return proxy;
  }

  async stop() {
    this.child.kill("SIGTERM");
    await once(this.child, "close");
  }
}

async function freePort() {
  const probe = createServer().listen(0, "127.0.0.1");
  await once(probe, "listening");
  const { port } = probe.address();
  probe.close();
  await once(probe, "close");
  return port;
}
