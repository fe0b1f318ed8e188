// SPDX-License-Identifier: Apache-2.0
// The surface in two places: as arrays, for whoever picks or measures, and in the GPU's memory.
import { BufferAttribute, GLBufferAttribute, type BufferGeometry } from "three";
import type { Block, Change, Level, Part } from "../core/types.ts";
import { GpuArray, type Steps } from "./gpu-array.ts";

/** Bytes uploaded between two looks at the clock, where they do not come in blocks. */
const kSlice = 1 << 16;

type Numbers = Float32Array | Int16Array | Uint16Array | Uint32Array;

/** An attribute whose array three.js leaves to its owner to upload. */
class MirroredAttribute extends BufferAttribute {
  readonly isGLBufferAttribute = true;
  readonly elementSize: number;

  constructor(values: Numbers, width: number, readonly buffer: WebGLBuffer | undefined, readonly type: number) {
    super(values, width, values instanceof Int16Array || values instanceof Uint16Array);
    this.elementSize = values.BYTES_PER_ELEMENT;
  }
}

/** One kind of numbers. `values` has room for the finest level, a page of memory is taken when it is written to; or the GPU alone has them. */
interface Kind {
  /** As three.js calls it. */
  name: string;
  width: 3 | 4;
  Numbers: { new (buffer: ArrayBuffer, offset: number, length: number): Numbers; BYTES_PER_ELEMENT: number };
  values?: Numbers;
  type: number;
}

/** Blocks that have come, and buffers of those that were taken over. */
export interface Inbox {
  blocks: Block[];
  taken: ArrayBuffer[];
}

export class SurfaceBuffers {
  readonly #kinds = new Map<Part, Kind>();
  readonly #gpu = new Map<Part, GpuArray>();
  #gl: WebGL2RenderingContext | undefined;
  #vertices = 0;
  #triangles = 0;
  #version = 0;
  #taking = false;

  constructor(
    private readonly geometry: BufferGeometry,
    finest: Level,
    coloured: boolean,
  ) {
    const { FLOAT, SHORT, UNSIGNED_SHORT, UNSIGNED_INT } = WebGL2RenderingContext;
    const { vertices, faces } = finest, kinds = this.#kinds;
    kinds.set("positions", { name: "position", width: 3, Numbers: Float32Array, values: new Float32Array(3 * vertices), type: FLOAT });
    kinds.set("normals", { name: "normal", width: 4, Numbers: Int16Array, values: new Int16Array(4 * vertices), type: SHORT });
    if (coloured) {
      kinds.set("colours", { name: "color", width: 4, Numbers: Uint16Array, values: new Uint16Array(4 * vertices), type: UNSIGNED_SHORT });
    }
    kinds.set("indices", { name: "index", width: 3, Numbers: Uint32Array, values: new Uint32Array(3 * faces), type: UNSIGNED_INT });
    kinds.set("fromPositions", { name: "fromPosition", width: 4, Numbers: Float32Array, type: FLOAT });
    kinds.set("fromNormals", { name: "fromNormal", width: 4, Numbers: Int16Array, type: SHORT });
    this.#describe();
  }

  /** Draws by `gl` from now on; what there is goes there in slices, and is drawn after the last. */
  *attach(gl: WebGL2RenderingContext): Steps {
    this.#gl = gl;
    for (const [part, kind] of this.#kinds) {
      if (!kind.values) continue;
      const values = kind.values.subarray(0, kind.width * this.#count(part));
      const array = this.#begin(part, this.#count(part));
      for (let at = 0; at < values.byteLength; at += kSlice) {
        array.put(at, new Uint8Array(values.buffer, at, Math.min(kSlice, values.byteLength - at)));
        yield "go on";
        if (!this.#gl) return;
      }
    }
    yield "next frame";
    if (this.#gl) this.#commit();
  }

  /** The context is lost, and all arrays with it: nothing is drawn until attach(). */
  detach(): void {
    this.#gl = undefined;
    this.#gpu.clear();
    this.#describe();
  }

  /** Takes over a change block by block; it is drawn after the last step. With `morph` its vertices start where they come from. */
  *take(change: Change, inbox: Inbox, morph: boolean): Steps {
    this.#taking = true;
    for (const part of this.#gl ? this.#kinds.keys() : []) {
      if (morph || !isOrigin(part)) this.#begin(part, part === "indices" ? change.triangles : change.vertices);
    }
    for (let left = change.blocks; left > 0; --left) {
      while (inbox.blocks.length === 0) yield "wait";
      const block = inbox.blocks.shift() as Block;
      if (morph || !isOrigin(block.part)) this.#put(block);
      inbox.taken.push(block.buffer);
      yield "go on";
    }
    yield "next frame";
    this.#vertices = change.vertices;
    this.#triangles = change.triangles;
    this.#taking = false;
    if (!morph) this.#forget();
    this.#commit();
  }

  /** All vertices have arrived: what they came from is given back, unless more are about to start. */
  settle(): void {
    if (this.#taking || !this.#gpu.has("fromPositions")) return;
    this.#forget();
    this.#describe();
  }

  dispose(): void {
    for (const array of this.#gpu.values()) array.dispose();
    this.#gpu.clear();
  }

  #forget(): void {
    for (const part of ["fromPositions", "fromNormals"] as const) {
      this.#gpu.get(part)?.dispose();
      this.#gpu.delete(part);
    }
  }

  #count(part: Part): number {
    return part === "indices" ? this.#triangles : this.#vertices;
  }

  #begin(part: Part, count: number): GpuArray {
    const { width, Numbers } = this.#kinds.get(part) as Kind;
    const array = this.#gpu.get(part) ?? new GpuArray(this.#gl as WebGL2RenderingContext, part === "indices" ? "ELEMENT_ARRAY_BUFFER" : "ARRAY_BUFFER");
    this.#gpu.set(part, array);
    array.begin(count * width * Numbers.BYTES_PER_ELEMENT);
    return array;
  }

  #put({ part, first, count, buffer }: Block): void {
    const kind = this.#kinds.get(part);
    if (!kind) return;
    const news = new kind.Numbers(buffer, 0, kind.width * count);
    kind.values?.set(news, kind.width * first);
    this.#gpu.get(part)?.put(first * kind.width * news.BYTES_PER_ELEMENT, news);
  }

  #commit(): void {
    for (const array of this.#gpu.values()) array.commit();
    this.#describe();
  }

  /** Tells the geometry of the present state. Fresh attributes each time: three.js asks for the buffers of those that it does not know. */
  #describe(): void {
    ++this.#version;
    for (const [part, kind] of this.#kinds) {
      if (kind.values) this.#mirror(part, kind, kind.values);
      else this.#lendOut(part, kind);
    }
    this.geometry.setDrawRange(0, this.#gpu.size > 0 ? 3 * this.#triangles : -1); // three.js draws even 0, which needs buffers
  }

  #mirror(part: Part, { name, width, type }: Kind, values: Numbers): void {
    const present = values.subarray(0, width * this.#count(part));
    const attribute = new MirroredAttribute(present, part === "indices" ? 1 : width, this.#gpu.get(part)?.buffer, type);
    attribute.version = this.#version; // so three's wireframe knows that the index is another one
    if (part === "indices") this.geometry.setIndex(attribute);
    else this.geometry.setAttribute(name, attribute);
  }

  /** What the GPU alone has. */
  #lendOut(part: Part, { name, width, type, Numbers }: Kind): void {
    const buffer = this.#gpu.get(part)?.buffer;
    if (!buffer) return void this.geometry.deleteAttribute(name);
    const size = Numbers.BYTES_PER_ELEMENT as 2 | 4; // as three.js' types want it
    const attribute = Object.assign(new GLBufferAttribute(buffer, type, width, size, this.#vertices), {
      normalized: type !== WebGL2RenderingContext.FLOAT,
    });
    this.geometry.setAttribute(name, attribute as unknown as BufferAttribute);
  }
}

function isOrigin(part: Part): boolean {
  return part === "fromPositions" || part === "fromNormals";
}
