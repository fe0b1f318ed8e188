// SPDX-License-Identifier: Apache-2.0
import { createServer, type Server, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import { FileSource } from "@core/file-source.ts";
import { openSource } from "@core/open-source.ts";

const file = Uint8Array.from({ length: 100_000 }, (_, i) => i % 251);
const never = new AbortController().signal;

let server: Server;
let ranges: string[];
let answer: (range: RegExpExecArray | null, response: ServerResponse) => void;

beforeEach(async () => {
  ranges = [];
  server = createServer((request, response) => {
    ranges.push(request.headers.range ?? "");
    answer(/bytes=(\d+)-(\d+)/.exec(request.headers.range ?? ""), response);
  });
  await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
});
afterEach(() => {
  server.closeAllConnections();
  server.close();
});

function url(): string {
  return `http://127.0.0.1:${(server.address() as AddressInfo).port}/model.pmesh`;
}

function withRange(range: RegExpExecArray | null, response: ServerResponse): void {
  const begin = Number(range?.[1]), end = Math.min(Number(range?.[2]) + 1, file.length);
  response.writeHead(206, { "Content-Range": `bytes ${begin}-${end - 1}/${file.length}` });
  response.end(file.subarray(begin, end));
}

describe("FileSource", () => {
  test("takes parts by Range where the host knows it", async () => {
    answer = withRange;
    const source = new FileSource(url());
    expect(await source.head(never)).toEqual(file.slice(0, 1024));
    expect(await source.getBytes({ offset: 50_000, length: 10 }, never)).toEqual(file.slice(50_000, 50_010));
    // Sends no request, because these bytes have already arrived with the head.
    expect(await source.getBytes({ offset: 16_374, length: 10 }, never)).toEqual(file.slice(16_374, 16_384));
    expect(ranges).toEqual(["bytes=0-16383", "bytes=50000-50009"]);
  });

  test("uses the start of the file before the first response has ended", async () => {
    let rest: () => void = () => undefined;
    answer = (range, response) => {
      if (ranges.length > 1) return withRange(range, response);
      response.writeHead(206, { "Content-Range": `bytes 0-16383/${file.length}` });
      response.write(file.subarray(0, 3000));
      rest = () => response.end(file.subarray(3000, 16_384));
    };
    const source = new FileSource(url());
    expect(await source.head(never)).toEqual(file.slice(0, 1024));
    expect(await source.getBytes({ offset: 1024, length: 1976 }, never)).toEqual(file.slice(1024, 3000));
    expect(ranges.length).toBe(1);
    const across = source.getBytes({ offset: 1024, length: 40_000 }, never);
    rest();
    expect(await across).toEqual(file.slice(1024, 41_024));
    expect(ranges).toEqual(["bytes=0-16383", "bytes=16384-41023"]);
  });

  test("takes parts of a download still in progress if the host ignores Range", async () => {
    let rest: () => void = () => undefined;
    answer = (_, response) => {
      response.writeHead(200);
      response.write(file.subarray(0, 60_000));
      rest = () => response.end(file.subarray(60_000));
    };
    const source = new FileSource(url());
    expect(await source.head(never)).toEqual(file.slice(0, 1024));
    expect(await source.getBytes({ offset: 32_768, length: 20_000 }, never)).toEqual(file.slice(32_768, 52_768));
    const last = source.getBytes({ offset: 90_000, length: 10_000 }, never);
    rest();
    expect(await last).toEqual(file.slice(90_000));
    expect(ranges.length).toBe(1);
  });

  test("says that the file ends too early", async () => {
    answer = (_, response) => response.end(file);
    const source = new FileSource(url());
    await source.head(never);
    await expect(source.getBytes({ offset: 99_999, length: 2 }, never)).rejects.toThrow("ends too early");
  });

  test("says what is wrong when the file is missing", async () => {
    answer = (_, response) => response.writeHead(404).end();
    await expect(new FileSource(url()).head(never)).rejects.toThrow("is not there (404)");
  });

  test("continues after the response to a request that the page has sent", async () => {
    answer = withRange;
    const source = new FileSource(url(), fetch(url(), { headers: { Range: "bytes=0-16383" } }));
    expect(await source.head(never)).toEqual(file.slice(0, 1024));
    expect(await source.getBytes({ offset: 1024, length: 40_000 }, never)).toEqual(file.slice(1024, 41_024));
    expect(ranges).toEqual(["bytes=0-16383", "bytes=16384-41023"]);
  });

  test("ends a wait when aborted", async () => {
    answer = (_, response) => void response.writeHead(200).write(file.subarray(0, 40_000));
    const source = new FileSource(url());
    await source.head(never);
    const abort = new AbortController();
    const waiting = source.getBytes({ offset: 50_000, length: 10 }, abort.signal);
    abort.abort();
    await expect(waiting).rejects.toMatchObject({ name: "AbortError" });
    source.close();
  });
});

describe("openSource", () => {
  test("knows a model page, an API model and a file apart", async () => {
    const asked: string[] = [];
    server.prependListener("request", (request) => asked.push(request.url ?? ""));
    answer = (_, response) => response.end(file);
    const { origin } = new URL(url());
    for (const path of ["/models/m1", "/api/v1/models/m1", "/api/v1/models/m1/file.pmesh", "/static/a.pmesh", "/models/a.pmesh"]) {
      await openSource(origin + path, "http").head(never);
    }
    expect(asked).toEqual([
      "/api/v1/models/m1/head", "/api/v1/models/m1/head", "/api/v1/models/m1/file.pmesh", "/static/a.pmesh",
      "/models/a.pmesh",
    ]);
  });
});
