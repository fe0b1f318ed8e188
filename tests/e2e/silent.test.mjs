// SPDX-License-Identifier: Apache-2.0
// Tests that the shipped nginx configuration ends connections that send no whole request. The tests
// use shorter timeouts than the configuration, and wait for the end of a connection.
import assert from "node:assert/strict";
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { createConnection } from "node:net";
import { after, before, test } from "node:test";
import { connect } from "node:tls";
import { freePort, Nginx } from "./nginx.mjs";

const kTimeouts = [
  ["client_header_timeout 10s;  # for the handshakes of all servers", "client_header_timeout 1s;"],
  ["client_header_timeout 10s;  # for the headers of requests", "client_header_timeout 1s;"],
  ["keepalive_timeout 30s;  # after a redirect", "keepalive_timeout 1s;"],
  ["keepalive_timeout 30s;  # after a response", "keepalive_timeout 1s;"],
];
let nginx, ca;

before(async () => {
  nginx = await Nginx.start([`127.0.0.1:${await freePort()}`], kTimeouts);
  ca = await readFile(nginx.certificate);
});

after(() => nginx?.stop());

/** Sends `bytes` and waits until nginx closes the connection. Returns what nginx sent. */
async function receivedOf(socket, bytes) {
  const received = [];
  socket.on("error", () => undefined).on("data", (piece) => received.push(piece));
  socket.write(bytes);
  await once(socket, "close", { signal: AbortSignal.timeout(20_000) });
  return Buffer.concat(received).toString();
}

const secure = () => connect({ host: "127.0.0.1", port: nginx.port, ca, servername: "localhost" });

test("a connection without a handshake, or without a request, ends", async () => {
  assert.equal(await receivedOf(createConnection(nginx.port, "127.0.0.1"), ""), "");
  assert.equal(await receivedOf(createConnection(nginx.plainPort, "127.0.0.1"), "GET / HTTP/1.1\r\nHost: loc"), "");
});

test("a connection whose header is not complete ends, and so does an idle one", async () => {
  await receivedOf(secure(), "GET / HTTP/1.1\r\nHost: localhost\r\nX: ");
  assert.match(await receivedOf(secure(), "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"), /^HTTP\/1.1 502 /);
  const redirected = await receivedOf(createConnection(nginx.plainPort, "127.0.0.1"), "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  assert.match(redirected, /^HTTP\/1.1 308 /);
});
