// SPDX-License-Identifier: Apache-2.0
import { kBlockBytes, Shown } from "@core/change.ts";
import type { SurfaceArray, Surface } from "@core/types.ts";

/** Returns a surface with `count` vertices and `count` faces; vertex i is at (i, height(i), 0). */
function surface(count: number, height: (i: number) => number = () => 0): Surface {
  const positions = new Float32Array(3 * count), normals = new Int16Array(4 * count);
  for (let i = 0; i < count; ++i) {
    positions.set([i, height(i), 0], 3 * i);
    normals.set([i % 1000, 0, 1, 0], 4 * i);
  }
  const indices = Uint32Array.from({ length: 3 * count }, (_, i) => i);
  return { vertices: count, triangles: count, bytes: count, positions, normals, attributes: [], indices };
}

const noParents = (count: number) => Uint32Array.from({ length: count }, (_, i) => i);

type Way = ReturnType<Shown["change"]>;

/** A copy of the surface, as a page keeps it. take() applies all pieces of a change to the copy. */
class Mirror {
  positions = new Float32Array(3 * 20_000);
  normals = new Int16Array(4 * 20_000);
  indices = new Uint32Array(3 * 20_000);
  fromPositions = new Float32Array(4 * 20_000);
  fromNormals = new Int16Array(4 * 20_000);
  coordinates = new Float32Array(2 * 20_000);
  fromCoordinates = new Float32Array(2 * 20_000);

  take({ pieces }: Way): this {
    const buffer = new ArrayBuffer(kBlockBytes);
    for (const { part, first, count, write } of pieces) {
      write(buffer);
      if (part === "colour") throw new Error("there are none");
      const values = this[part];
      const width = part.endsWith("oordinates") ? 2 : part.startsWith("from") || part === "normals" ? 4 : 3;
      values.set(new (values.constructor as Float32ArrayConstructor)(buffer, 0, width * count), width * first);
    }
    return this;
  }
}

/** Returns [first, count] of each piece of an array, in vertices or faces. */
function places({ pieces }: Way, part: SurfaceArray): number[][] {
  return pieces.filter((piece) => piece.part === part).map(({ first, count }) => [first, count]);
}

describe("Shown", () => {
  test("gives all of the first state", () => {
    const way = new Shown().change(surface(10), noParents(10), false);
    expect([places(way, "positions"), places(way, "indices")]).toEqual([[[0, 10]], [[0, 10]]]);
    expect(new Mirror().take(way).positions.subarray(0, 30)).toEqual(surface(10).positions);
    expect([way.change.number, way.change.blocks]).toEqual([1, way.pieces.length]);
  });

  test("returns no piece without a change", () => {
    const shown = new Shown();
    shown.change(surface(5000), noParents(5000), false);
    expect(shown.change(surface(5000), noParents(5000), false).pieces).toEqual([]);
  });

  test("gives what is new and the neighbourhood of what has moved, and no more", () => {
    const shown = new Shown();
    shown.change(surface(10_000), noParents(10_000), false);
    const way = shown.change(surface(12_000, (i) => (i === 5000 ? 1 : 0)), noParents(12_000), false);
    expect(places(way, "positions")).toEqual([[4096, 2048], [8192, 3808]]);
    expect(places(way, "indices")).toEqual([[8192, 3808]]);
  });

  test("gives a large change in pieces that each fit into a block", () => {
    const way = new Shown().change(surface(10_000), noParents(10_000), false);
    expect(places(way, "positions")).toEqual([[0, 5461], [5461, 4539]]);
    expect(places(way, "fromPositions")).toEqual([[0, 4096], [4096, 4096], [8192, 1808]]);
  });

  test("leads a page through every state", () => {
    const shown = new Shown(), mirror = new Mirror();
    for (const [count, moved] of [[100, 0], [9000, 50], [15_000, 8999], [15_001, 3], [7000, 6000]] as const) {
      const state = surface(count, (i) => (i === moved ? 7 : 0));
      mirror.take(shown.change(state, noParents(count), false));
      expect(mirror.positions.subarray(0, 3 * count)).toEqual(state.positions);
      expect(mirror.normals.subarray(0, 4 * count)).toEqual(state.normals);
      expect(mirror.indices.subarray(0, 3 * count)).toEqual(state.indices);
    }
  });

  test("lets a new vertex part from its nearest ancestor that was shown", () => {
    const shown = new Shown();
    shown.change(surface(3, () => 5), noParents(3), false);
    // Vertex 3 was split from vertex 1, and vertex 4 from vertex 3. Vertex 5 belongs to an inserted
    // component.
    const parents = Uint32Array.of(0, 1, 2, 1, 3, 5);
    const { fromPositions } = new Mirror().take(shown.change(surface(6), parents, false));
    const from = Array.from({ length: 6 }, (_, i) => [...fromPositions.subarray(4 * i, 4 * i + 4)]);
    expect(from).toEqual([[0, 5, 0, 2], [1, 5, 0, 2], [2, 5, 0, 2], [1, 5, 0, 2], [1, 5, 0, 2], [5, 0, 0, 2]]);
  });

  test("lets nothing move where the vertices have new numbers", () => {
    const shown = new Shown();
    shown.change(surface(3, () => 5), noParents(3), false);
    const { fromPositions, positions } = new Mirror().take(shown.change(surface(3), noParents(3), true));
    expect([fromPositions[1], fromPositions[5]]).toEqual([positions[1], positions[4]]);
  });

  test("lets the texture coordinates of a new vertex part from those of its ancestor", () => {
    const shown = new Shown(), mirror = new Mirror();
    const at = (count: number, u: number) => ({ ...surface(count), coordinates: Float32Array.from({ length: 2 * count }, (_, i) => i + u) });
    mirror.take(shown.change(at(4, 0), noParents(4), false));
    expect([...mirror.coordinates.subarray(0, 8)]).toEqual([0, 1, 2, 3, 4, 5, 6, 7]);
    mirror.take(shown.change(at(5, 0.5), Uint32Array.of(0, 1, 2, 3, 2), false));
    expect([...mirror.coordinates.subarray(4, 10)]).toEqual([4.5, 5.5, 6.5, 7.5, 8.5, 9.5]);
    expect([...mirror.fromCoordinates.subarray(4, 10)]).toEqual([4, 5, 6, 7, 4, 5]);
  });

  test("finds a change of texture coordinates alone", () => {
    const shown = new Shown();
    const at = (u: number) => ({ ...surface(3), coordinates: new Float32Array(6).fill(u) });
    shown.change(at(0), noParents(3), false);
    expect(places(shown.change(at(1), noParents(3), false), "coordinates")).toEqual([[0, 3]]);
  });
});
