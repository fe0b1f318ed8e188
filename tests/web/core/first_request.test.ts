// SPDX-License-Identifier: Apache-2.0
// Tests that a source in the worker sees the response to the page's request as if it had sent the request itself.
import { createServer, type Server, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import { firstRequest, relay, RelayedResponse, type ResponsePart } from "@core/first-request.ts";
import { openSource } from "@core/open-source.ts";

const file = Uint8Array.from({ length: 30_000 }, (_, i) => i % 251);
const never = new AbortController().signal;

let server: Server;
let asked: string[];
let answer: (response: ServerResponse) => void;

beforeEach(async () => {
  asked = [];
  server = createServer(({ url, headers }, response) => {
    asked.push([url, headers.range, headers.authorization].filter(Boolean).join(" "));
    answer(response);
  });
  await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
});
afterEach(() => {
  server.closeAllConnections();
  server.close();
});

const address = (path: string) => `http://127.0.0.1:${(server.address() as AddressInfo).port}${path}`;

/** Opens a model as page and worker do. Records the parts that the page passes on. */
function open(path: string, token = "", signal = never) {
  const url = address(path), relayed = new RelayedResponse(), parts: ResponsePart[] = [];
  const request = firstRequest(url, "http", token);
  const passed = request && relay(request, signal, (part) => {
    parts.push(part);
    relayed.receive(part);
  });
  return { source: openSource(url, "http", token, relayed.response), passed, parts };
}

test.each([
  ["/bust.pmesh", "", "/bust.pmesh bytes=0-16383"],
  ["/models/m1", "", "/api/v1/models/m1/head"],
  ["/api/v1/models/m1", "secret", "/api/v1/models/m1/head Bearer secret"],
])("asks once for the start of %s", async (path, token, request) => {
  answer = (response) => response.writeHead(path.endsWith("pmesh") ? 206 : 200).end(file);
  const head = await open(path, token).source.head(never);
  expect(head).toEqual(file.slice(0, head.length));
  expect(asked).toEqual([request]);
});

test("passes bytes on before the response has ended", async () => {
  let rest: () => void = () => undefined;
  answer = (response) => {
    response.writeHead(200).write(file.subarray(0, 2000));
    rest = () => response.end(file.subarray(2000));
  };
  const { source } = open("/bust.pmesh");
  expect(await source.head(never)).toEqual(file.slice(0, 1024));
  const last = source.getBytes({ offset: 20_000, length: 10_000 }, never);
  rest();
  expect(await last).toEqual(file.slice(20_000));
  expect(asked.length).toBe(1);
});

test.each([
  [404, "is not there (404)"], [403, "was refused with status 403"], [503, "was refused with status 503"],
])("names a refusal with status %i, without a second request", async (status, message) => {
  answer = (response) => response.writeHead(status).end("a page about the error");
  await expect(open("/bust.pmesh").source.head(never)).rejects.toThrow(message);
  await expect(open("/models/m1").source.head(never)).rejects.toThrow(message);
  expect(asked.length).toBe(2);
});

test("lets the worker repeat a request that got no response", async () => {
  answer = (response) => (asked.length === 1 ? response.destroy() : response.end(file));
  const { source, parts } = open("/models/m1");
  expect(await source.head(never)).toEqual(file);
  expect(parts).toEqual(["lost"]);
});

test("says that the file cannot be reached if the response breaks off", async () => {
  answer = (response) => {
    response.writeHead(200, { "Content-Length": file.length }).write(file.subarray(0, 2000), () => response.destroy());
  };
  const { source } = open("/bust.pmesh");
  await expect(source.head(never).then(() => source.getBytes({ offset: 0, length: 9000 }, never))).rejects.toThrow("cannot be reached");
});

test("passes nothing on after the model is closed", async () => {
  answer = (response) => void response.writeHead(200).write(file.subarray(0, 2000));
  const closing = new AbortController(), { source, passed, parts } = open("/bust.pmesh", "", closing.signal);
  await source.head(never);
  const before = parts.length;
  closing.abort();
  await passed;
  expect(parts.length).toBe(before);
});

test("leaves the head of a model that comes by WebSocket to the worker", () => {
  expect(firstRequest("https://museum.example/models/m1", "ws", "")).toBeUndefined();
  expect(firstRequest("https://museum.example/models/m1", "ws", "secret")?.url).toBe("https://museum.example/api/v1/models/m1/head");
});

test.each([["/models/m1", ""], ["/api/v1/models/m1", "secret"]])("passes on how %s is presented", async (path, token) => {
  answer = (response) => response.writeHead(200, { "Vitrine-Presentation": '{"scale":2}' }).end(file);
  const { source } = open(path, token);
  await source.head(never);
  expect(source.presentation).toBe('{"scale":2}');
});
