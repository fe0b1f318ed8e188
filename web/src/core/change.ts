// SPDX-License-Identifier: Apache-2.0
// What is new of a surface: a page copies, uploads and moves that alone. It goes there in blocks of
// a few kilobytes, so that none holds the page up.
import type { Change, Part, Place, Surface } from "./types.ts";

/** Bytes of a buffer that carries a block. */
export const kBlockBytes = 1 << 16;

/** Vertices or faces that count as changed together. */
const kTogether = 2048;

type Numbers = Float32Array | Int16Array | Uint16Array | Uint32Array;

interface Pair {
  now: Numbers;
  before: Numbers;
  /** Numbers of one vertex or face. */
  width: number;
}

/** A block that is not written yet. */
export interface Piece extends Place {
  write(buffer: ArrayBuffer): void;
}

/** Keeps the state that was shown last. */
export class Shown {
  #last: Surface | undefined;
  #number = 0;

  /**
   * The way from the surface given before to this one. A vertex that was there moves from its old
   * place, another from that of its nearest ancestor that was: `parents` names who split. With
   * `anew` the numbers stand for other vertices than before, so nothing moves.
   */
  change(surface: Surface, parents: Uint32Array, anew: boolean): { change: Change; pieces: Piece[] } {
    const last = this.#last;
    this.#last = surface;
    const { vertices, triangles, bytes, positions, normals, colours, indices } = surface;
    const vertexRuns = changed(vertices, last?.vertices ?? 0, pairs(surface, last));
    const faceRuns = changed(triangles, last?.triangles ?? 0, last ? [{ now: indices, before: last.indices, width: 3 }] : []);
    const moved = origins(vertexRuns, parents, anew || !last ? 0 : last.vertices);
    const number = ++this.#number;
    const pieces = [
      ...copied("positions", positions, 3, vertexRuns),
      ...copied("normals", normals, 4, vertexRuns),
      ...(colours ? copied("colours", colours, 4, vertexRuns) : []),
      ...copied("indices", indices, 3, faceRuns),
      ...left("fromPositions", positions, last?.positions, 3, moved, vertexRuns, number),
      ...left("fromNormals", normals, last?.normals, 4, moved, vertexRuns),
    ];
    return { change: { number, vertices, triangles, bytes, blocks: pieces.length }, pieces };
  }
}

/** Pieces that hold what the runs of `values` do. */
function* copied(part: Part, values: Numbers, width: number, runs: Uint32Array): Generator<Piece> {
  for (const { first, count } of places(runs, width * values.BYTES_PER_ELEMENT)) {
    const write = (buffer: ArrayBuffer) =>
      likeness(values, buffer).set(values.subarray(width * first, width * (first + count)));
    yield { part, first, count, write };
  }
}

/** Pieces that hold where the vertices of the runs come from: `moved` has an origin for each, in their order. */
function* left(
  part: Part, now: Numbers, before: Numbers | undefined, width: number, moved: Int32Array, runs: Uint32Array, number?: number,
): Generator<Piece> {
  let behind = 0;
  for (const { first, count } of places(runs, 4 * now.BYTES_PER_ELEMENT)) {
    const begin = behind;
    const write = (buffer: ArrayBuffer) => {
      const out = likeness(now, buffer);
      for (let i = 0; i < count; ++i) {
        const origin = moved[begin + i] as number;
        const [source, at] = origin < 0 || !before ? [now, first + i] : [before, origin];
        for (let k = 0; k < width; ++k) out[4 * i + k] = source[width * at + k] as number;
        if (number !== undefined) out[4 * i + 3] = number;
      }
    };
    yield { part, first, count, write };
    behind += count;
  }
}

/** The runs in places of which each fits into a block. */
function* places(runs: Uint32Array, elementBytes: number): Generator<Omit<Place, "part">> {
  const most = Math.floor(kBlockBytes / elementBytes);
  for (let i = 0; i < runs.length; i += 2) {
    const begin = runs[i] as number, end = begin + (runs[i + 1] as number);
    for (let first = begin; first < end; first += most) yield { first, count: Math.min(most, end - first) };
  }
}

/** `buffer` as numbers of the kind of `values`. */
function likeness(values: Numbers, buffer: ArrayBuffer): Numbers {
  return new (values.constructor as new (buffer: ArrayBuffer) => Numbers)(buffer);
}

function pairs(now: Surface, before: Surface | undefined): Pair[] {
  if (!before) return [];
  const colours = now.colours && before.colours && { now: now.colours, before: before.colours, width: 4 };
  return [
    { now: now.positions, before: before.positions, width: 3 },
    { now: now.normals, before: before.normals, width: 4 },
    ...(colours ? [colours] : []),
  ];
}

/** Runs of changed elements, ascending: where each begins and how many it has. */
function changed(count: number, known: number, arrays: Pair[]): Uint32Array {
  const runs: number[] = [];
  for (let begin = 0; begin < count; begin += kTogether) {
    const end = Math.min(begin + kTogether, count);
    if (end <= known && arrays.every((pair) => equal(pair, begin, end))) continue;
    const last = runs.length - 2;
    if (last >= 0 && (runs[last] as number) + (runs[last + 1] as number) === begin) runs[last + 1] = end - (runs[last] as number);
    else runs.push(begin, end - begin);
  }
  return Uint32Array.from(runs);
}

function equal({ now, before, width }: Pair, begin: number, end: number): boolean {
  for (let i = width * begin; i < width * end; ++i) if (now[i] !== before[i]) return false;
  return true;
}

/** For each vertex of the runs the nearest ancestor below `known`, or -1. */
function origins(runs: Uint32Array, parents: Uint32Array, known: number): Int32Array {
  const out = new Int32Array(total(runs));
  let at = 0;
  eachOf(runs, (vertex) => {
    let ancestor = vertex;
    while (ancestor >= known && (parents[ancestor] as number) < ancestor) ancestor = parents[ancestor] as number;
    out[at++] = ancestor < known ? ancestor : -1;
  });
  return out;
}

function eachOf(runs: Uint32Array, use: (index: number) => void): void {
  for (let i = 0; i < runs.length; i += 2) {
    const begin = runs[i] as number, end = begin + (runs[i + 1] as number);
    for (let index = begin; index < end; ++index) use(index);
  }
}

function total(runs: Uint32Array): number {
  let sum = 0;
  for (let i = 1; i < runs.length; i += 2) sum += runs[i] as number;
  return sum;
}
