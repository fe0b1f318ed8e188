// SPDX-License-Identifier: Apache-2.0
// Finds the changed ranges of a surface. The page copies, uploads and morphs only these ranges.
// Each range is split into blocks of at most 64 KiB, so that no single task blocks the page.
import { kAttributes } from "./attributes.ts";
import type { Change, ElementRange, NumericArray, Surface, SurfaceArray } from "./types.ts";

/** Size in bytes of the buffer for one block. */
export const kBlockBytes = 1 << 16;

/**
 * Number of vertices or faces that are compared as one unit. If any of them differs, all of them
 * count as changed.
 */
const kTogether = 2048;

interface Pair {
  now: NumericArray;
  before: NumericArray;
  /** Values per vertex or face. */
  width: number;
}

/** A block whose buffer has not been filled yet. */
export interface Piece extends ElementRange {
  write(buffer: ArrayBuffer): void;
}

/** Stores the last surface shown, and computes the change from it to the next surface. */
export class Shown {
  #last: Surface | undefined;
  #number = 0;

  /**
   * Returns the change from the previous surface to `surface`. An existing vertex morphs from its
   * previous position. A new vertex morphs from the position of its nearest ancestor in the
   * previous surface. `parents` holds, for each vertex, the vertex that was split to create it. If
   * `isRenumbered`, vertex indices do not match those of the previous surface, so no vertex morphs.
   */
  change(surface: Surface, parents: Uint32Array, isRenumbered: boolean): { change: Change; pieces: Piece[] } {
    const last = this.#last;
    this.#last = surface;
    const { vertices, triangles, bytes, positions, normals, attributes, coordinates, indices } = surface;
    const vertexRuns = changed(vertices, last?.vertices ?? 0, pairs(surface, last));
    const faceRuns = changed(triangles, last?.triangles ?? 0, last ? [{ now: indices, before: last.indices, width: 3 }] : []);
    const moved = origins(vertexRuns, parents, isRenumbered || !last ? 0 : last.vertices);
    const number = ++this.#number;
    const pieces = [
      ...copied("positions", positions, 3, vertexRuns),
      ...copied("normals", normals, 4, vertexRuns),
      ...attributes.flatMap(({ semantic, values }) => [...copied(semantic, values, kAttributes[semantic].width, vertexRuns)]),
      ...(coordinates ? copied("coordinates", coordinates, 2, vertexRuns) : []),
      ...copied("indices", indices, 3, faceRuns),
      ...left({ part: "fromPositions", now: positions, before: last?.positions, width: 3, room: 4 }, moved, vertexRuns, number),
      ...left({ part: "fromNormals", now: normals, before: last?.normals, width: 4, room: 4 }, moved, vertexRuns),
      ...(coordinates ? left({ part: "fromCoordinates", now: coordinates, before: last?.coordinates, width: 2, room: 2 }, moved, vertexRuns) : []),
    ];
    return { change: { number, vertices, triangles, bytes, blocks: pieces.length }, pieces };
  }
}

/**
 * Yields pieces that copy ranges of `values`. `runs` holds the first index and the count of each
 * range.
 */
function* copied(part: SurfaceArray, values: NumericArray, width: number, runs: Uint32Array): Generator<Piece> {
  for (const { first, count } of places(runs, width * values.BYTES_PER_ELEMENT)) {
    const write = (buffer: ArrayBuffer) =>
      likeness(values, buffer).set(values.subarray(width * first, width * (first + count)));
    yield { part, first, count, write };
  }
}

/**
 * The source of a `from…` array, which holds the values from which vertices morph. `now` and
 * `before` are the values after and before the change, with `width` numbers per vertex. The `from…`
 * array itself has `room` numbers per vertex.
 */
interface Origin {
  part: SurfaceArray;
  now: NumericArray;
  before: NumericArray | undefined;
  width: number;
  room: number;
}

/**
 * Yields pieces with the values from which the vertices of `runs` start to morph. `moved` has one
 * entry per vertex: the index of these values in `before`, or -1 if the vertex does not move. If
 * `number` is given, it becomes the fourth number of each vertex.
 */
function* left({ part, now, before, width, room }: Origin, moved: Int32Array, runs: Uint32Array, number?: number): Generator<Piece> {
  let behind = 0;
  for (const { first, count } of places(runs, room * now.BYTES_PER_ELEMENT)) {
    const begin = behind;
    const write = (buffer: ArrayBuffer) => {
      const out = likeness(now, buffer);
      for (let i = 0; i < count; ++i) {
        const origin = moved[begin + i] as number;
        const [source, at] = origin < 0 || !before ? [now, first + i] : [before, origin];
        for (let k = 0; k < width; ++k) out[room * i + k] = source[width * at + k] as number;
        if (number !== undefined) out[room * i + 3] = number;
      }
    };
    yield { part, first, count, write };
    behind += count;
  }
}

/** Splits the runs into ranges that fit into one block each. */
function* places(runs: Uint32Array, elementBytes: number): Generator<Omit<ElementRange, "part">> {
  const most = Math.floor(kBlockBytes / elementBytes);
  for (let i = 0; i < runs.length; i += 2) {
    const begin = runs[i] as number, end = begin + (runs[i + 1] as number);
    for (let first = begin; first < end; first += most) yield { first, count: Math.min(most, end - first) };
  }
}

/** Returns a view on `buffer` of the same array type as `values`. */
function likeness(values: NumericArray, buffer: ArrayBuffer): NumericArray {
  return new (values.constructor as new (buffer: ArrayBuffer) => NumericArray)(buffer);
}

function pairs(now: Surface, before: Surface | undefined): Pair[] {
  if (!before) return [];
  return [
    { now: now.positions, before: before.positions, width: 3 },
    { now: now.normals, before: before.normals, width: 4 },
    ...(now.coordinates && before.coordinates ? [{ now: now.coordinates, before: before.coordinates, width: 2 }] : []),
    ...now.attributes.map(({ semantic, values }, i) => (
      { now: values, before: before.attributes[i]?.values ?? new Uint16Array(), width: kAttributes[semantic].width })),
  ];
}

/**
 * Compares the first `count` elements of the arrays with the `known` elements that the arrays had
 * before the change. Returns the runs of changed or added elements in ascending order, as pairs of
 * first index and count.
 */
function changed(count: number, known: number, arrays: Pair[]): Uint32Array {
  const runs: number[] = [];
  for (let begin = 0; begin < count; begin += kTogether) {
    const end = Math.min(begin + kTogether, count);
    if (end <= known && arrays.every((pair) => isEqual(pair, begin, end))) continue;
    const last = runs.length - 2;
    if (last >= 0 && (runs[last] as number) + (runs[last + 1] as number) === begin) runs[last + 1] = end - (runs[last] as number);
    else runs.push(begin, end - begin);
  }
  return Uint32Array.from(runs);
}

function isEqual({ now, before, width }: Pair, begin: number, end: number): boolean {
  for (let i = width * begin; i < width * end; ++i) if (now[i] !== before[i]) return false;
  return true;
}

/**
 * Returns one index for each vertex of the runs: the vertex itself if its index is below `known`,
 * otherwise its nearest ancestor whose index is below `known`. The index is -1 if there is no such
 * ancestor.
 */
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
