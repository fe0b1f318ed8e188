// SPDX-License-Identifier: Apache-2.0
import { StreamSource, pairs } from "@core/stream-source.ts";

/** A fake WebSocket. The test plays the server. */
class FakeSocket {
  static readonly OPEN = 1;
  static last: FakeSocket;
  readyState = 1;
  sent: Record<string, unknown>[] = [];
  onopen?: () => void;
  onclose?: () => void;
  onmessage?: (event: { data: string | ArrayBuffer }) => void;
  closed = false;

  constructor(readonly url: URL, readonly protocol: string) {
    FakeSocket.last = this;
  }

  send = (text: string) => void this.sent.push(JSON.parse(text) as Record<string, unknown>);
  close = () => void (this.closed = true);

  slice(level: number, region: number, offset: number, length: number, bytes: number[]): void {
    const data = new ArrayBuffer(16 + bytes.length);
    const view = new DataView(data);
    view.setUint16(2, level, true);
    view.setUint32(4, region, true);
    view.setUint32(8, offset, true);
    view.setUint32(12, length, true);
    new Uint8Array(data, 16).set(bytes);
    this.onmessage?.({ data });
  }

  model(sha256: string): void {
    this.onmessage?.({ data: JSON.stringify({ type: "model", model: 0, sha256 }) });
  }

  done(turn = 1): void {
    this.onmessage?.({ data: JSON.stringify({ type: "done", model: 0, turn, bytes: 1, triangles: 1 }) });
  }
}

const never = new AbortController().signal;
const chunk = (level: number, length: number) => ({ offset: 0, length, sha256: `${level}`.repeat(64), level, region: 0 });
let asked: string[];

beforeEach(() => {
  asked = [];
  vi.stubGlobal("WebSocket", FakeSocket);
  vi.stubGlobal("fetch", async (url: string) => {
    asked.push(url);
    return new Response(new Uint8Array([9, 9, 9]));
  });
});
afterEach(() => vi.unstubAllGlobals());

describe("StreamSource", () => {
  test("knows how the model is presented before its head has arrived", async () => {
    const source = new StreamSource("http://host/api/v1", "m1"), head = source.head(never), socket = FakeSocket.last;
    socket.onmessage?.({ data: JSON.stringify({ type: "model", model: 0, sha256: "ab", presentation: '{"scale":2}' }) });
    socket.slice(0, 0, 0, 3, [1, 2, 3]);
    await head;
    expect(source.presentation).toBe('{"scale":2}');
  });

  test("says what it wants and holds, and joins the slices of a chunk", async () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 2 }, [0, 1, 4]);
    const socket = FakeSocket.last;
    expect([socket.url.href, socket.protocol]).toEqual(["ws://host/api/v1/models/m1/stream", "pmesh.v1"]);
    expect(socket.sent).toEqual([{ type: "have", chunks: [[0, 1], [4, 4]] }, { type: "want", turn: 1, level: 2 }]);
    const bytes = source.getBytes(chunk(1, 3), never);
    socket.slice(1, 0, 0, 3, [1, 2]);
    socket.slice(1, 0, 2, 3, [3]);
    expect(await bytes).toEqual(new Uint8Array([1, 2, 3]));
    expect(socket.sent.slice(2)).toEqual([{ type: "ack", bytes: 2 }, { type: "ack", bytes: 1 }]);
    expect(asked).toEqual([]);
  });

  test("says what it holds in as many messages as it takes", () => {
    const held = Array.from({ length: 5000 }, (_, i) => 2 * i + 100_000);
    new StreamSource("http://host/api/v1", "m1").want({ level: 2 }, held);
    const haves = FakeSocket.last.sent.filter(({ type }) => type === "have");
    expect(haves.map(({ chunks }) => (chunks as unknown[]).length <= 4096)).toEqual([true, true, true]);
    expect(haves.every((message) => JSON.stringify(message).length <= 64 * 1024)).toBe(true);
    expect(haves.flatMap(({ chunks }) => chunks)).toEqual(pairs(held));
  });

  test("takes the head from the handshake on", async () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    const head = source.head(never);
    expect(FakeSocket.last.url.href).toBe("ws://host/api/v1/models/m1/stream?head=true");
    FakeSocket.last.slice(0, 0, 0, 3, [1, 2]);
    FakeSocket.last.slice(0, 0, 2, 3, [3]);
    expect(await head).toEqual(new Uint8Array([1, 2, 3]));
    expect(asked).toEqual([]);
  });

  test("fetches the head over HTTP where the stream ends before it", async () => {
    const head = new StreamSource("http://host/api/v1", "m1").head(never);
    FakeSocket.last.onclose?.();
    expect(await head).toEqual(new Uint8Array([9, 9, 9]));
  });

  test("joins chunks whose slices alternate", async () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 2 }, []);
    const socket = FakeSocket.last;
    const both = [source.getBytes(chunk(1, 2), never), source.getBytes(chunk(2, 2), never)];
    socket.slice(1, 0, 0, 2, [1]);
    socket.slice(2, 0, 0, 2, [3]);
    socket.slice(1, 0, 1, 2, [2]);
    socket.slice(2, 0, 1, 2, [4]);
    expect(await Promise.all(both)).toEqual([new Uint8Array([1, 2]), new Uint8Array([3, 4])]);
  });

  test("an answer to an earlier want ends nothing", async () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 1 }, []);
    source.want({ level: 2 }, []);
    const bytes = source.getBytes(chunk(2, 1), never);
    FakeSocket.last.done(1);
    FakeSocket.last.slice(2, 0, 0, 1, [7]);
    expect(await bytes).toEqual(new Uint8Array([7]));
    expect(asked).toEqual([]);
  });

  test("keeps what comes before it is asked for", async () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 1 }, []);
    FakeSocket.last.slice(1, 0, 0, 1, [7]);
    FakeSocket.last.done();
    expect(await source.getBytes(chunk(1, 1), never)).toEqual(new Uint8Array([7]));
    expect(asked).toEqual([]);
  });

  test("fetches over HTTP what the stream does not bring", async () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 1 }, []);
    const bytes = source.getBytes(chunk(1, 3), never);
    FakeSocket.last.done();
    expect(await bytes).toEqual(new Uint8Array([9, 9, 9]));
    expect(asked).toEqual([`http://host/api/v1/chunks/${"1".repeat(64)}`]);
  });

  test("fetches a picture over HTTP while the stream sends chunks", async () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 2 }, []);
    const picture = { offset: 100, length: 3, sha256: "a".repeat(64) };
    expect(await source.getBytes(picture, never)).toEqual(new Uint8Array([9, 9, 9]));
    expect(asked).toEqual([`http://host/api/v1/chunks/${"a".repeat(64)}`]);
  });

  test("fetches over HTTP when the connection ends", async () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 1 }, []);
    const bytes = source.getBytes(chunk(1, 3), never);
    FakeSocket.last.onclose?.();
    expect(await bytes).toEqual(new Uint8Array([9, 9, 9]));
  });

  test("hangs up where another connection brings another file", () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 1 }, []);
    const first = FakeSocket.last;
    first.model("a");
    first.readyState = 3;
    for (const sha256 of ["a", "b"]) {
      source.want({ level: 1 }, []);
      FakeSocket.last.model(sha256);
      expect(FakeSocket.last.closed).toBe(sha256 === "b");
      FakeSocket.last.readyState = 3;
    }
  });

  test("ends a wait when aborted", async () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 1 }, []);
    const abort = new AbortController();
    const bytes = source.getBytes(chunk(1, 3), abort.signal);
    abort.abort();
    await expect(bytes).rejects.toMatchObject({ name: "AbortError" });
  });

  test("hangs up on a slice that does not fit its chunk", () => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 1 }, []);
    FakeSocket.last.slice(1, 0, 2, 3, [1, 2]);
    expect(FakeSocket.last.closed).toBe(true);
  });

  test.each(["no JSON", new ArrayBuffer(15)])("hangs up on what is no message of the protocol", (data) => {
    const source = new StreamSource("http://host/api/v1", "m1");
    source.want({ level: 1 }, []);
    FakeSocket.last.onmessage?.({ data });
    expect(FakeSocket.last.closed).toBe(true);
  });
});

test("indices are sent as inclusive pairs", () => {
  expect(pairs([])).toEqual([]);
  expect(pairs([3])).toEqual([[3, 3]]);
  expect(pairs([0, 1, 2, 5, 7, 8])).toEqual([[0, 2], [5, 5], [7, 8]]);
});
