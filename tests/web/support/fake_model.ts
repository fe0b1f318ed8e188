// SPDX-License-Identifier: Apache-2.0
// A fake decoder that only records calls, and a fake source whose responses the test sends one by
// one. They let tests produce every order of events without timers.
import type { ModelDecoder, Sink } from "@core/session.ts";
import type { ByteRange, Source } from "@core/source.ts";
import type { Change, ModelInfo, Picture, Surface, Want } from "@core/types.ts";

export const kHeader = 16, kBase = 8, kChunk = 10, kAtlas = 4, kPicture = 6;

/** Describes a model with one region and `chunks` layers of kChunk bytes each; level i has 100 (i + 1) faces. */
export function fakeInfo(chunks: number): ModelInfo {
  const head = kHeader + kBase;
  return {
    levels: Array.from({ length: chunks + 1 }, (_, i) => ({
      vertices: 50 * (i + 1), faces: 100 * (i + 1), maxError: chunks - i, rmsError: 0, cumulativeBytes: head + kChunk * i,
    })),
    chunks: Array.from({ length: chunks }, (_, i) => ({
      level: i + 1, region: 0, offset: head + kChunk * i, length: kChunk, sha256: `${i}`,
    })),
    baseOffset: kHeader, baseLength: kBase, fileBytes: head + kChunk * chunks,
    attributes: [], bits: 12, step: 1, unit: "mm", centre: [0, 0, 0],
  };
}

/** Gives the model a texture: an atlas and one picture in the head, and two finer pictures at the end of the file. */
export function textured(info: ModelInfo): ModelInfo {
  const headEnd = kHeader + kBase, more = kAtlas + kPicture, picture = { role: "colour" as const, length: kPicture };
  return {
    ...info,
    levels: info.levels.map((level) => ({ ...level, cumulativeBytes: level.cumulativeBytes + more })),
    chunks: info.chunks.map((chunk) => ({ ...chunk, offset: chunk.offset + more })),
    fileBytes: info.fileBytes + more + 2 * kPicture,
    texture: {
      atlasOffset: headEnd, atlasLength: kAtlas, alphaMode: "opaque", alphaCutoff: 0.5, isDoubleSided: false, isUnlit: false, inHead: 1,
      pictures: [
        { ...picture, side: 256, offset: headEnd + kAtlas, sha256: "100" },
        { ...picture, side: 1024, offset: info.fileBytes + more, sha256: "101" },
        { ...picture, side: 4096, offset: info.fileBytes + more + kPicture, sha256: "102" },
      ],
    },
  };
}

export class FakeDecoder implements ModelDecoder {
  applied: number[] = [];
  starts = 0;
  /** Chunks that count as damaged. The error of each entry is thrown once. */
  damaged: { chunk: number; error: Error }[] = [];
  #goal = 0;
  #requested = 0;

  constructor(readonly info: ModelInfo) {}

  headerLength = () => kHeader;
  open = () => this.info;
  readonly parents = new Uint32Array();
  checkBase = () => undefined;
  checkAtlas = () => undefined;
  /** The errors that checkPicture() throws, one in each call, beginning with the last. */
  damagedPictures: Error[] = [];
  atlasBytes = 0;

  checkPicture(): void {
    const error = this.damagedPictures.pop();
    if (error) throw error;
  }

  start(_: unknown, atlas: Uint8Array): void {
    ++this.starts;
    this.atlasBytes = atlas.length;
  }

  trim = () => undefined;

  want(want: Want): boolean {
    this.#goal = "level" in want ? want.level : 0;
    const back = this.applied.length > this.#goal;
    if (back) this.applied = [];
    this.#requested = this.applied.length;
    return back;
  }

  nextChunk(): number | undefined {
    return this.#requested < this.#goal ? this.#requested++ : undefined;
  }

  checkChunk = () => undefined;

  apply(chunk: number, bytes: Uint8Array): void {
    const fault = this.damaged.findIndex((entry) => entry.chunk === chunk);
    if (fault >= 0) throw (this.damaged.splice(fault, 1)[0] as { error: Error }).error;
    if (chunk !== this.applied.length) throw new Error(`chunk ${chunk} came out of order`);
    if (bytes[0] !== chunk) throw new Error(`chunk ${chunk} has the bytes of ${bytes[0]}`);
    this.applied.push(chunk);
  }

  get bytesHeld(): number {
    return kHeader + kBase + kChunk * this.applied.length;
  }

  surface(): Surface {
    return {
      triangles: 100 * (this.applied.length + 1), vertices: 0, bytes: this.bytesHeld,
      positions: new Float32Array(), normals: new Int16Array(), attributes: [], indices: new Uint32Array(),
    };
  }
}

/** A request that the test has not answered yet. */
export interface Request {
  range: ByteRange;
  signal: AbortSignal;
  answer(bytes: Uint8Array): void;
  fail(error: Error): void;
}

export class ControlledSource implements Source {
  readonly requests: Request[] = [];
  closed = false;
  readonly wants: { want: Want; have: number[] }[] = [];

  constructor(private readonly headBytes = kHeader + kBase) {}

  head(): Promise<Uint8Array> {
    return Promise.resolve(new Uint8Array(this.headBytes));
  }

  want = (want: Want, have: number[]) => void this.wants.push({ want, have });

  getBytes(range: ByteRange, signal: AbortSignal): Promise<Uint8Array> {
    return new Promise((resolve, reject) => {
      signal.addEventListener("abort", () => reject(signal.reason as Error));
      this.requests.push({ range, signal, answer: resolve, fail: reject });
    });
  }

  close(): void {
    this.closed = true;
  }

  /** Responds to the newest request for a chunk. */
  answer(chunk: number): void {
    this.find(chunk).answer(new Uint8Array(kChunk).fill(chunk));
  }

  find(chunk: number): Request {
    const found = this.requests.findLast(({ range }) => range.sha256 === `${chunk}`);
    if (!found) throw new Error(`chunk ${chunk} was not requested`);
    return found;
  }

  get asked(): number[] {
    return this.requests.map(({ range }) => Number(range.sha256));
  }
}

/**
 * Records the surfaces shown. With `hold`, a surface counts as displayed only after the test has
 * called release().
 */
export class RecordingSink implements Sink {
  readonly triangles: number[] = [];
  hold = false;
  #release: (() => void) | undefined;

  opened = () => undefined;
  /** Index and size of each picture, and the number of surfaces shown before it. */
  readonly pictures: { index: number; side: number; bytes: number; surfaces: number }[] = [];

  picture(index: number, _: Picture, side: number, bytes: Uint8Array): Promise<void> {
    this.pictures.push({ index, side, bytes: bytes.length, surfaces: this.triangles.length });
    return Promise.resolve();
  }

  progress = () => undefined;
  readonly reasons: (string | undefined)[] = [];

  stalled = (reason: string | undefined) => void this.reasons.push(reason);

  show(change: Change): Promise<void> {
    this.triangles.push(change.triangles);
    return this.hold ? new Promise((resolve) => (this.#release = resolve)) : Promise.resolve();
  }

  release(): void {
    this.#release?.();
  }
}

/** Waits until all code has run that does not wait for timers or responses. */
export async function settle(): Promise<void> {
  for (let i = 0; i < 30; ++i) await new Promise((resolve) => setImmediate(resolve));
}
