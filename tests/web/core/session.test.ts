// SPDX-License-Identifier: Apache-2.0
import { Session } from "@core/session.ts";
import { DamagedError, ModelError, UnreachableError } from "@core/types.ts";
import {
  ControlledSource, FakeDecoder, RecordingSink, fakeInfo, kAtlas, kBase, kHeader, kPicture, settle, textured,
} from "../support/fake_model.ts";


function setUp(chunks: number, headBytes?: number, info = fakeInfo(chunks)) {
  const source = new ControlledSource(headBytes);
  const decoder = new FakeDecoder(info);
  const sink = new RecordingSink();
  const waits: number[] = [];
  let go: () => void = () => undefined;
  const wait = (milliseconds: number) => new Promise<void>((resolve) => (waits.push(milliseconds), (go = resolve)));
  const session = new Session(source, decoder, sink, new AbortController(), wait);
  return { source, decoder, sink, session, waits, go: () => go() };
}

async function opened(chunks: number) {
  const parts = setUp(chunks);
  await parts.session.open();
  return parts;
}

describe("Session", () => {
  test("shows the base mesh and requests no layer by itself", async () => {
    const { source, sink } = await opened(5);
    await settle();
    expect(sink.triangles).toEqual([100]);
    expect(source.requests).toEqual([]);
  });

  test("tells how the source presents the model", async () => {
    const presentation = { rotation: [0, 0, 0, 1], scale: 2, view: null, poster: null, light: null };
    const { source, sink, session } = setUp(1), told = vi.spyOn(sink, "opened");
    Object.assign(source, { presentation: JSON.stringify(presentation) });
    await session.open();
    expect(told.mock.calls[0]?.[0].presentation).toEqual(presentation);
  });

  test("fetches the rest of a head that does not fit the first request", async () => {
    const { source, session, decoder } = setUp(1, kHeader);
    const open = session.open();
    await settle();
    expect(source.requests.map(({ range }) => range)).toEqual([{ offset: kHeader, length: 8 }]);
    source.requests[0]?.answer(new Uint8Array(8));
    await open;
    expect(decoder.starts).toBe(1);
  });

  test("applies chunks in the planner's order whatever order they arrive in", async () => {
    const { source, decoder, session } = await opened(3);
    const done = session.refine({ level: 3 });
    await settle();
    for (const chunk of [2, 1]) source.answer(chunk);
    await settle();
    expect(decoder.applied).toEqual([]);
    source.answer(0);
    expect(await done).toBe(true);
    expect(decoder.applied).toEqual([0, 1, 2]);
  });

  test("keeps a window of requests under way and no more", async () => {
    const { source, session } = await opened(20);
    void session.refine({ level: 20 });
    await settle();
    expect(source.asked).toEqual([0, 1, 2, 3, 4, 5]);
    source.answer(0);
    await settle();
    expect(source.asked).toEqual([0, 1, 2, 3, 4, 5, 6]);
  });

  test("gives up a want when another comes, and the requests that only it needed", async () => {
    const { source, decoder, session } = await opened(4);
    const first = session.refine({ level: 4 });
    await settle();
    const second = session.refine({ level: 2 });
    await settle();
    expect(source.find(0).signal.aborted).toBe(false);
    expect(source.find(3).signal.aborted).toBe(true);
    source.answer(0);
    source.answer(1);
    expect(await first).toBe(false);
    expect(await second).toBe(true);
    expect(decoder.applied).toEqual([0, 1]);
  });

  test("asks again for a chunk whose request it had given up", async () => {
    const { source, decoder, session } = await opened(2);
    void session.refine({ level: 2 });
    await settle();
    void session.refine({ level: 0 });
    const third = session.refine({ level: 1 });
    await settle();
    source.answer(0);
    expect(await third).toBe(true);
    expect(decoder.applied).toEqual([0]);
    expect(source.asked).toEqual([0, 1, 0]);
  });

  test("goes back to a coarser state and forth again without fetching twice", async () => {
    const { source, decoder, session, sink } = await opened(3);
    const fine = session.refine({ level: 3 });
    await settle();
    for (const chunk of [0, 1, 2]) source.answer(chunk);
    await fine;
    sink.triangles.length = 0;
    expect(await session.refine({ level: 1 })).toBe(true);
    expect(decoder.applied).toEqual([0]);
    expect(sink.triangles).toEqual([200]); // the base mesh alone is never shown
    expect(await session.refine({ level: 3 })).toBe(true);
    expect(source.asked).toEqual([0, 1, 2]);
    expect(sink.triangles.at(-1)).toBe(400);
  });

  test("sends the next surface only when the last is on display, and then the newest", async () => {
    const { source, session, sink } = await opened(4);
    sink.hold = true;
    const done = session.refine({ level: 4 });
    await settle();
    for (const chunk of [0, 1, 2, 3]) source.answer(chunk);
    await settle();
    expect(sink.triangles).toEqual([100, 200]);
    sink.hold = false;
    sink.release();
    expect(await done).toBe(true);
    expect(sink.triangles).toEqual([100, 200, 500]);
  });

  test("fetches a damaged chunk once more", async () => {
    const { source, decoder, session } = await opened(1);
    decoder.damaged = [{ chunk: 0, error: new DamagedError("flipped") }];
    const done = session.refine({ level: 1 });
    await settle();
    source.answer(0);
    await settle();
    expect(source.asked).toEqual([0, 0]);
    source.answer(0);
    expect(await done).toBe(true);
  });

  test("names a chunk that stays damaged and keeps what it has", async () => {
    const { source, decoder, session, sink } = await opened(2);
    decoder.damaged = [1, 2].map(() => ({ chunk: 1, error: new DamagedError("level 2 is damaged") }));
    const done = session.refine({ level: 2 });
    const failure = expect(done).rejects.toThrow("level 2 is damaged");
    await settle();
    source.answer(0);
    source.answer(1);
    await settle();
    source.answer(1);
    await failure;
    expect(sink.triangles.at(-1)).toBe(200);
  });

  test("does not feed the decoder again after it has refused a chunk's content", async () => {
    const { source, decoder, session } = await opened(1);
    decoder.damaged = [{ chunk: 0, error: new ModelError("impossible split") }];
    const failure = expect(session.refine({ level: 1 })).rejects.toThrow("impossible split");
    await settle();
    source.answer(0);
    await failure;
    expect(source.asked).toEqual([0]);
  });

  test("waits for a server that is gone, longer each time, and resumes where it was", async () => {
    const { source, session, sink, waits, go, decoder } = await opened(2);
    const done = session.refine({ level: 2 });
    await settle();
    source.answer(0);
    await settle();
    for (let i = 0; i < 7; ++i) {
      source.find(1).fail(new UnreachableError("nobody answers"));
      await settle();
      go();
      await settle();
    }
    expect(waits).toEqual([500, 1000, 2000, 4000, 8000, 15000, 15000]);
    source.answer(1);
    expect(await done).toBe(true);
    expect(decoder.applied).toEqual([0, 1]);
    expect(source.asked.filter((chunk) => chunk === 0)).toEqual([0]);
    expect(source.wants.at(-1)).toEqual({ want: { level: 2 }, have: [0] });
    expect(sink.reasons).toEqual([...Array<string>(7).fill("nobody answers"), undefined]);
  });

  test("does not ask again for what is not there", async () => {
    const { source, session } = await opened(1);
    const failure = expect(session.refine({ level: 1 })).rejects.toThrow("not there");
    await settle();
    source.find(0).fail(new ModelError("not there"));
    await failure;
    expect(source.asked).toEqual([0]);
  });

  test("leaves what is on display until it is as far again", async () => {
    const { source, session, sink } = setUp(3);
    await session.open(true);
    const done = session.refine({ level: 3 });
    await settle();
    source.answer(0);
    source.answer(1);
    await settle();
    expect(sink.triangles).toEqual([]);
    source.answer(2);
    expect(await done).toBe(true);
    expect(sink.triangles).toEqual([400]);
  });

  test("asks a stream for no more bytes than a view's plan has", async () => {
    const { source, session } = await opened(2);
    const view = { camera: [], fov: 30, width: 10, height: 10, pixels: 1, bytes: Infinity, triangles: 5 };
    await session.refine({ view });
    expect(source.wants.at(-1)?.want).toEqual({ view: { ...view, bytes: 24 } });
  });

  test("ends its requests and closes its source", async () => {
    const { source, session } = await opened(2);
    const done = session.refine({ level: 2 });
    await settle();
    session.close();
    expect(source.closed).toBe(true);
    expect(source.find(0).signal.aborted).toBe(true);
    expect(await done).toBe(false);
  });
});

describe("Session of a textured model", () => {
  async function openedTextured() {
    const parts = setUp(3, kHeader + kBase + kAtlas + kPicture, textured(fakeInfo(3)));
    await parts.session.open();
    return parts;
  }

  test("shows the picture of the head before the base mesh", async () => {
    const { source, sink, decoder } = await openedTextured();
    expect(decoder.atlasBytes).toBe(kAtlas);
    expect(sink.pictures).toEqual([{ index: 0, side: 256, bytes: kPicture, surfaces: 0 }]);
    expect(source.requests).toEqual([]);
  });

  test("fetches the atlas and the first picture with the rest of the head", async () => {
    const { source, session, sink } = setUp(1, kHeader, textured(fakeInfo(1)));
    const open = session.open(), rest = kBase + kAtlas + kPicture;
    await settle();
    expect(source.requests.map(({ range }) => range)).toEqual([{ offset: kHeader, length: rest }]);
    source.requests[0]?.answer(new Uint8Array(rest));
    await open;
    expect(sink.pictures).toHaveLength(1);
  });

  test("fetches a finer picture by its hash and place", async () => {
    const { source, session, sink } = await openedTextured();
    const shown = session.showPicture(2);
    expect(source.requests.map(({ range }) => range)).toEqual([{ offset: 70, length: kPicture, sha256: "102" }]);
    source.requests[0]?.answer(new Uint8Array(kPicture));
    await shown;
    expect(sink.pictures.at(-1)).toEqual({ index: 2, side: 4096, bytes: kPicture, surfaces: 1 });
  });

  test("shows a picture in other sizes without fetching it again", async () => {
    const { source, session, sink } = await openedTextured();
    const shown = session.showPicture(2, 1448);
    source.requests[0]?.answer(new Uint8Array(kPicture));
    await shown;
    await session.showPicture(2, 2048);
    expect(sink.pictures.slice(1).map(({ index, side }) => [index, side])).toEqual([[2, 1448], [2, 2048]]);
    expect(source.requests).toHaveLength(1);
  });

  test("shows the picture of the head again without fetching it", async () => {
    const { source, session, sink } = await openedTextured();
    await session.showPicture(0);
    expect(sink.pictures.map(({ index }) => index)).toEqual([0, 0]);
    expect(source.requests).toEqual([]);
  });

  test("fetches a damaged picture once more, and shows none that stays damaged", async () => {
    const { source, session, sink, decoder } = await openedTextured();
    decoder.damagedPictures = [new DamagedError("torn"), new DamagedError("torn")];
    const failed = expect(session.showPicture(1)).rejects.toThrow("torn");
    source.requests[0]?.answer(new Uint8Array(kPicture));
    await settle();
    source.requests[1]?.answer(new Uint8Array(kPicture));
    await failed;
    expect(source.requests).toHaveLength(2);
    expect(sink.pictures).toHaveLength(1);
  });

  test("waits with a picture for a server that is gone", async () => {
    const { source, session, sink, waits, go } = await openedTextured();
    const shown = session.showPicture(1);
    source.requests[0]?.fail(new UnreachableError("gone"));
    await settle();
    expect(waits).toHaveLength(1);
    go();
    await settle();
    source.requests[1]?.answer(new Uint8Array(kPicture));
    await shown;
    expect(sink.pictures.at(-1)?.index).toBe(1);
  });

  test("ends the request for a picture when it is closed", async () => {
    const { source, session } = await openedTextured();
    const shown = session.showPicture(1);
    session.close();
    await shown;
    expect(source.requests[0]?.signal.aborted).toBe(true);
  });
});
