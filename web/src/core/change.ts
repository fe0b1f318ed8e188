// SPDX-License-Identifier: Apache-2.0
// What is new of a surface: a page copies, uploads and moves that alone.
import type { Change, Surface } from "./types.ts";

/** Vertices or faces that count as changed together. */
const kBlock = 2048;

type Numbers = Float32Array | Int16Array | Uint16Array | Uint32Array;

interface Pair {
  now: Numbers;
  before: Numbers;
  /** Numbers of one vertex or face. */
  width: number;
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
  change(surface: Surface, parents: Uint32Array, anew: boolean): Change {
    const last = this.#last;
    this.#last = surface;
    const { vertices, triangles, bytes, positions, normals, colours, indices } = surface;
    const vertexRuns = changed(vertices, last?.vertices ?? 0, pairs(surface, last));
    const faceRuns = changed(triangles, last?.triangles ?? 0, last ? [{ now: indices, before: last.indices, width: 3 }] : []);
    const moved = origins(vertexRuns, parents, anew || !last ? 0 : last.vertices);
    return {
      number: ++this.#number, vertices, triangles, bytes, vertexRuns, faceRuns,
      positions: gather(positions, vertexRuns, 3),
      normals: gather(normals, vertexRuns, 4),
      colours: colours && gather(colours, vertexRuns, 4),
      indices: gather(indices, faceRuns, 3),
      ...this.#places(moved, last, surface, vertexRuns),
    };
  }

  /** Where the vertices of the runs come from, the change's number behind each place. */
  #places(moved: Int32Array, last: Surface | undefined, surface: Surface, runs: Uint32Array) {
    const fromPositions = new Float32Array(4 * moved.length), fromNormals = new Int16Array(4 * moved.length);
    let out = 0;
    eachOf(runs, (vertex) => {
      const origin = moved[out] as number;
      const [source, at] = origin < 0 || !last ? [surface, vertex] : [last, origin];
      for (let k = 0; k < 3; ++k) {
        fromPositions[4 * out + k] = source.positions[3 * at + k] as number;
        fromNormals[4 * out + k] = source.normals[4 * at + k] as number;
      }
      fromPositions[4 * out + 3] = this.#number;
      ++out;
    });
    return { fromPositions, fromNormals };
  }
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
  for (let begin = 0; begin < count; begin += kBlock) {
    const end = Math.min(begin + kBlock, count);
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

function gather<T extends Numbers>(values: T, runs: Uint32Array, width: number): T {
  const out = new (values.constructor as new (length: number) => T)(width * total(runs));
  for (let i = 0, at = 0; i < runs.length; i += 2) {
    const begin = runs[i] as number, count = runs[i + 1] as number;
    out.set(values.subarray(width * begin, width * (begin + count)), width * at);
    at += count;
  }
  return out;
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
