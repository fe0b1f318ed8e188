// SPDX-License-Identifier: Apache-2.0
// The buffers of a surface: arrays in main memory, which ray casting reads, and copies of them in
// GPU memory.
import type { BufferGeometry } from "three";
import type { Semantic } from "../core/attributes.ts";
import type { Block, Change, Level, NumericArray, SurfaceArray } from "../core/types.ts";
import { GpuArray, type Steps } from "./gpu-array.ts";
import { UploadedAttribute } from "./surface-geometry.ts";

/** Bytes uploaded per step, if an upload is not split into blocks. */
const kSlice = 1 << 16;

/** Name of each attribute in three.js, and its number of values per vertex in Surface. */
const kAttributes: Readonly<Record<Semantic, { name: string; width: 3 | 4 }>> = { colour: { name: "color", width: 4 } };

/**
 * One array of the surface. `values` has room for the finest level, or for more if chart borders
 * add vertices. The unused part takes no memory, because the operating system provides each page of
 * memory only when it is first written. Without `values`, the array exists only on the GPU.
 */
interface BufferedArray {
  /** Name of the attribute in three.js. */
  name: string;
  width: 2 | 3 | 4;
  ArrayType: { new (buffer: ArrayBuffer, offset: number, length: number): NumericArray; BYTES_PER_ELEMENT: number };
  values?: NumericArray;
  type: number;
}

/** Received blocks, and the buffers of blocks that have been processed. */
export interface Inbox {
  blocks: Block[];
  taken: ArrayBuffer[];
}

export class SurfaceBuffers {
  readonly #arrays = new Map<SurfaceArray, BufferedArray>();
  readonly #gpu = new Map<SurfaceArray, GpuArray>();
  #gl: WebGL2RenderingContext | undefined;
  #vertices = 0;
  #triangles = 0;
  #version = 0;
  #isTaking = false;

  constructor(
    private readonly geometry: BufferGeometry,
    finest: Level,
    attributes: readonly Semantic[],
    isTextured: boolean,
  ) {
    const { FLOAT, SHORT, UNSIGNED_SHORT, UNSIGNED_INT } = WebGL2RenderingContext;
    const { vertices, faces } = finest, arrays = this.#arrays;
    arrays.set("positions", { name: "position", width: 3, ArrayType: Float32Array, values: new Float32Array(3 * vertices), type: FLOAT });
    arrays.set("normals", { name: "normal", width: 4, ArrayType: Int16Array, values: new Int16Array(4 * vertices), type: SHORT });
    for (const semantic of attributes) {
      const { name, width } = kAttributes[semantic];
      arrays.set(semantic, { name, width, ArrayType: Uint16Array, values: new Uint16Array(width * vertices), type: UNSIGNED_SHORT });
    }
    if (isTextured) {
      arrays.set("coordinates", { name: "uv", width: 2, ArrayType: Float32Array, values: new Float32Array(2 * vertices), type: FLOAT });
      arrays.set("fromCoordinates", { name: "fromCoordinate", width: 2, ArrayType: Float32Array, type: FLOAT });
    }
    arrays.set("indices", { name: "index", width: 3, ArrayType: Uint32Array, values: new Uint32Array(3 * faces), type: UNSIGNED_INT });
    arrays.set("fromPositions", { name: "fromPosition", width: 4, ArrayType: Float32Array, type: FLOAT });
    arrays.set("fromNormals", { name: "fromNormal", width: 4, ArrayType: Int16Array, type: SHORT });
    this.#describe();
  }

  /** Bytes of the arrays in GPU memory. */
  get bytes(): number {
    return [...this.#gpu.values()].reduce((sum, { bytes }) => sum + bytes, 0);
  }

  /** Uses the context `gl` from now on. Uploads the current surface in slices, and draws it after the last slice. */
  *attach(gl: WebGL2RenderingContext): Steps {
    this.#gl = gl;
    for (const [part, kind] of this.#arrays) {
      if (!kind.values) continue;
      const values = kind.values.subarray(0, kind.width * this.#count(part));
      const array = this.#begin(part, this.#count(part));
      for (let at = 0; at < values.byteLength; at += kSlice) {
        array.put(at, new Uint8Array(values.buffer, at, Math.min(kSlice, values.byteLength - at)));
        yield "continue";
        if (!this.#gl) return;
      }
    }
    yield "next frame";
    if (this.#gl) this.#commit();
  }

  /** Handles a lost WebGL context, whose buffers are gone. Nothing is drawn until attach() is called. */
  detach(): void {
    this.#gl = undefined;
    this.#gpu.clear();
    this.#describe();
  }

  /**
   * Applies a change block by block. The change is drawn after the last step. With `morph`, its
   * vertices move from their `from…` positions.
   */
  *take(change: Change, inbox: Inbox, morph: boolean): Steps {
    this.#isTaking = true;
    yield* this.#reserve(change.vertices);
    for (const part of this.#gl ? this.#arrays.keys() : []) {
      if (morph || !isOrigin(part)) this.#begin(part, part === "indices" ? change.triangles : change.vertices);
    }
    for (let left = change.blocks; left > 0; --left) {
      while (inbox.blocks.length === 0) yield "wait";
      const block = inbox.blocks.shift() as Block;
      if (morph || !isOrigin(block.part)) this.#put(block);
      inbox.taken.push(block.buffer);
      yield "continue";
    }
    yield "next frame";
    this.#vertices = change.vertices;
    this.#triangles = change.triangles;
    this.#isTaking = false;
    if (!morph) this.#forget();
    this.#commit();
  }

  /** Makes room for `vertices` vertices in the arrays, slice by slice. */
  *#reserve(vertices: number): Steps {
    for (const [part, kind] of this.#arrays) {
      const { values, width, ArrayType } = kind;
      if (!values || part === "indices" || values.length >= width * vertices) continue;
      const length = width * Math.ceil(1.5 * vertices), slice = kSlice / ArrayType.BYTES_PER_ELEMENT;
      const larger = new ArrayType(new ArrayBuffer(length * ArrayType.BYTES_PER_ELEMENT), 0, length);
      for (let at = 0; at < width * this.#vertices; at += slice) {
        larger.set(values.subarray(at, Math.min(at + slice, values.length)), at);
        yield "continue";
      }
      kind.values = larger;
    }
  }

  /** Called when all morphs have finished. Frees the `from…` arrays, unless another change is in progress. */
  settle(): void {
    if (this.#isTaking || !this.#gpu.has("fromPositions")) return;
    this.#forget();
    this.#describe();
  }

  dispose(): void {
    for (const array of this.#gpu.values()) array.dispose();
    this.#gpu.clear();
  }

  #forget(): void {
    for (const part of ["fromPositions", "fromNormals", "fromCoordinates"] as const) {
      this.#gpu.get(part)?.dispose();
      this.#gpu.delete(part);
    }
  }

  #count(part: SurfaceArray): number {
    return part === "indices" ? this.#triangles : this.#vertices;
  }

  #begin(part: SurfaceArray, count: number): GpuArray {
    const { width, ArrayType } = this.#arrays.get(part) as BufferedArray;
    const array = this.#gpu.get(part) ?? new GpuArray(this.#gl as WebGL2RenderingContext, part === "indices" ? "ELEMENT_ARRAY_BUFFER" : "ARRAY_BUFFER");
    this.#gpu.set(part, array);
    array.begin(count * width * ArrayType.BYTES_PER_ELEMENT);
    return array;
  }

  #put({ part, first, count, buffer }: Block): void {
    const kind = this.#arrays.get(part);
    if (!kind) return;
    const news = new kind.ArrayType(buffer, 0, kind.width * count);
    kind.values?.set(news, kind.width * first);
    this.#gpu.get(part)?.put(first * kind.width * news.BYTES_PER_ELEMENT, news);
  }

  #commit(): void {
    for (const array of this.#gpu.values()) array.commit();
    this.#describe();
  }

  /**
   * Updates the geometry to the current state. Creates new attributes each time, because three.js
   * looks up the buffer of an attribute only once.
   */
  #describe(): void {
    ++this.#version;
    for (const [part, kind] of this.#arrays) {
      if (kind.values) this.#mirror(part, kind, kind.values);
      else this.#lendOut(part, kind);
    }
    // With -1, nothing is drawn. With 0, three.js would still issue a draw call, which needs
    // buffers.
    this.geometry.setDrawRange(0, this.#gpu.size > 0 ? 3 * this.#triangles : -1);
  }

  #mirror(part: SurfaceArray, { name, width, type }: BufferedArray, values: NumericArray): void {
    const present = values.subarray(0, width * this.#count(part));
    const attribute = new UploadedAttribute(present, part === "indices" ? 1 : width, this.#gpu.get(part)?.buffer, type);
    attribute.version = this.#version; // the new version makes three.js rebuild its wireframe index
    if (part === "indices") this.geometry.setIndex(attribute);
    else this.geometry.setAttribute(name, attribute);
  }

  /**
   * Sets the geometry's attribute for an array that exists only on the GPU. The attribute's own array of values stays empty.
   * Deletes the attribute if the GPU has no such array.
   */
  #lendOut(part: SurfaceArray, { name, width, type, ArrayType }: BufferedArray): void {
    const buffer = this.#gpu.get(part)?.buffer;
    if (!buffer) return void this.geometry.deleteAttribute(name);
    this.geometry.setAttribute(name, new UploadedAttribute(new ArrayType(new ArrayBuffer(0), 0, 0), width, buffer, type));
  }
}

function isOrigin(part: SurfaceArray): boolean {
  return part === "fromPositions" || part === "fromNormals" || part === "fromCoordinates";
}
