// SPDX-License-Identifier: Apache-2.0
import { eventData } from "@console/events.ts";

/** Returns a response body that arrives in these pieces. */
function body(...pieces: string[]): ReadableStream<Uint8Array> {
  return new ReadableStream({
    start(controller) {
      for (const piece of pieces) controller.enqueue(new TextEncoder().encode(piece));
      controller.close();
    },
  });
}

async function read(...pieces: string[]): Promise<string[]> {
  const all: string[] = [];
  for await (const data of eventData(body(...pieces))) all.push(data);
  return all;
}

test("events are passed on one by one, heartbeats are not", async () => {
  expect(await read("event: job\ndata: {\"a\":1}\n\n:\n\nevent: job\ndata: {\"a\":2}\n\n")).toEqual(['{"a":1}', '{"a":2}']);
});

test("pieces may end anywhere", async () => {
  const text = "event: job\ndata: Grüße\n\ndata: 2\n\n";
  for (let at = 1; at < text.length; ++at) expect(await read(text.slice(0, at), text.slice(at))).toEqual(["Grüße", "2"]);
});

test("lines of data belong together, and what is not whole is not told", async () => {
  expect(await read("data: a\ndata: b\n\ndata: half")).toEqual(["a\nb"]);
});

test("who looks away ends the body", async () => {
  let ended = false;
  const endless = new ReadableStream<Uint8Array>({
    pull: (controller) => controller.enqueue(new TextEncoder().encode("data: 1\n\n")),
    cancel: () => void (ended = true),
  });
  for await (const data of eventData(endless)) {
    expect(data).toBe("1");
    break;
  }
  expect(ended).toBe(true);
});
