// SPDX-License-Identifier: Apache-2.0
// Two sets of vertex and index buffers, used in turn: the hidden one is filled in slices while the
// other is on display, then they change places. Both grow by steps towards the model's final size.
import { BufferAttribute, type BufferGeometry } from "three";
import type { Level, Surface } from "../core/types.ts";

/** Elements copied between two looks at the clock. */
const kSlice = 1 << 16;
/** Room that is left when a buffer has to grow. */
const kGrowth = 4;

type Numbers = Float32Array | Int16Array | Uint16Array | Uint32Array;

class BufferSet {
  readonly position: BufferAttribute;
  readonly normal: BufferAttribute;
  readonly color: BufferAttribute | undefined;
  readonly index: BufferAttribute;

  constructor(
    readonly vertices: number,
    readonly faces: number,
    coloured: boolean,
  ) {
    this.position = new BufferAttribute(new Float32Array(3 * vertices), 3);
    this.normal = new BufferAttribute(new Int16Array(4 * vertices), 4, true);
    this.color = coloured ? new BufferAttribute(new Uint16Array(4 * vertices), 4, true) : undefined;
    this.index = new BufferAttribute(new Uint32Array(3 * faces), 1);
  }

  holds(surface: Surface): boolean {
    return surface.vertices <= this.vertices && surface.triangles <= this.faces;
  }
}

export class SurfaceBuffers {
  #front: BufferSet | undefined;
  #back: BufferSet | undefined;
  #versions = 0;

  constructor(
    private readonly geometry: BufferGeometry,
    private readonly final: Level,
  ) {}

  /** Fills the hidden set, a slice at each step; the last step brings it to the front. */
  *replace(surface: Surface): Generator<void> {
    if (!this.#back?.holds(surface)) this.#back = this.#allocate(surface);
    const back = this.#back;
    yield* fill(back.position, surface.positions);
    yield* fill(back.normal, surface.normals);
    if (back.color && surface.colours) yield* fill(back.color, surface.colours);
    yield* fill(back.index, surface.indices);
    this.#swap(back, surface);
  }

  #swap(back: BufferSet, surface: Surface): void {
    // Frees what the old sizes hold on the GPU; the present attributes are made anew when drawn.
    if (back.vertices !== this.#front?.vertices || back.faces !== this.#front.faces) this.geometry.dispose();
    this.geometry.setAttribute("position", back.position);
    this.geometry.setAttribute("normal", back.normal);
    if (back.color) this.geometry.setAttribute("color", back.color);
    // Ever larger versions over both sets tell three's wireframe that the index is another one.
    back.index.version = this.#versions = Math.max(this.#versions, back.index.version) + 1;
    this.geometry.setIndex(back.index);
    this.geometry.setDrawRange(0, 3 * surface.triangles);
    this.#back = this.#front;
    this.#front = back;
  }

  #allocate(surface: Surface): BufferSet {
    const room = (need: number, final: number) => Math.max(need, Math.min(kGrowth * need, final));
    return new BufferSet(
      room(surface.vertices, this.final.vertices),
      room(surface.triangles, this.final.faces),
      surface.colours !== undefined,
    );
  }
}

function* fill(attribute: BufferAttribute, values: Numbers): Generator<void> {
  const target = attribute.array as Numbers;
  for (let begin = 0; begin < values.length; begin += kSlice) {
    target.set(values.subarray(begin, begin + kSlice), begin);
    yield;
  }
  attribute.clearUpdateRanges();
  attribute.addUpdateRange(0, values.length);
  attribute.needsUpdate = true;
}
