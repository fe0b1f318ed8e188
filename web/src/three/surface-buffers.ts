// SPDX-License-Identifier: Apache-2.0
// The surface in two places: as arrays, for whoever picks or measures, and in the GPU's memory.
import { BufferAttribute, GLBufferAttribute, type BufferGeometry } from "three";
import type { Change, Level } from "../core/types.ts";
import { GpuArray, type Steps, type Target } from "./gpu-array.ts";

/** Bytes copied or uploaded between two looks at the clock. */
const kSlice = 1 << 18;

type Numbers = Float32Array | Int16Array | Uint16Array | Uint32Array;
type Name = "position" | "normal" | "color" | "index" | "fromPosition" | "fromNormal";

/** An attribute whose array three.js leaves to its owner to upload. */
class MirroredAttribute extends BufferAttribute {
  readonly isGLBufferAttribute = true;
  readonly elementSize: number;

  constructor(values: Numbers, width: number, readonly buffer: WebGLBuffer | undefined, readonly type: number) {
    super(values, width, !(values instanceof Float32Array));
    this.elementSize = values.BYTES_PER_ELEMENT;
  }
}

/** One kind of numbers: `values` has room for the finest level, a page of memory is taken when it is written to. */
interface Part {
  values: Numbers;
  width: number;
  target: Target;
  type: number;
}

export class SurfaceBuffers {
  readonly #parts = new Map<Name, Part>();
  readonly #gpu = new Map<Name, GpuArray>();
  #gl: WebGL2RenderingContext | undefined;
  #vertices = 0;
  #triangles = 0;
  #version = 0;

  constructor(
    private readonly geometry: BufferGeometry,
    finest: Level,
    coloured: boolean,
  ) {
    const add = (name: Name, values: Numbers, width: number, type: number, target: Target = "ARRAY_BUFFER") =>
      this.#parts.set(name, { values, width, target, type });
    const { FLOAT, SHORT, UNSIGNED_SHORT, UNSIGNED_INT } = WebGL2RenderingContext;
    add("position", new Float32Array(3 * finest.vertices), 3, FLOAT);
    add("normal", new Int16Array(4 * finest.vertices), 4, SHORT);
    if (coloured) add("color", new Uint16Array(4 * finest.vertices), 4, UNSIGNED_SHORT);
    add("index", new Uint32Array(3 * finest.faces), 3, UNSIGNED_INT, "ELEMENT_ARRAY_BUFFER");
    this.#describe();
  }

  /** Draws by `gl` from now on; what there is goes there in slices, and is drawn after the last. */
  *attach(gl: WebGL2RenderingContext): Steps {
    this.#gl = gl;
    const vertices = Uint32Array.of(0, this.#vertices), faces = Uint32Array.of(0, this.#triangles);
    for (const [name, { values, width }] of this.#parts) {
      const count = name === "index" ? this.#triangles : this.#vertices;
      yield* this.#array(name, values, width, count).stage(values.subarray(0, width * count), kSlice);
    }
    yield true;
    this.#commit([...this.#parts.keys()], vertices, faces);
  }

  /** The context is lost: nothing is drawn until attach(). */
  detach(): void {
    this.#gl = undefined;
    for (const array of this.#gpu.values()) array.abandon();
    this.#gpu.clear();
    this.#describe();
  }

  /** Takes over a change in slices; it is drawn after the last step. With `morph` its vertices start where they come from. */
  *take(change: Change, morph: boolean): Steps {
    const news: [Name, Numbers][] = [["position", change.positions], ["normal", change.normals], ["index", change.indices]];
    if (change.colours) news.push(["color", change.colours]);
    if (this.#gl && morph) news.push(["fromPosition", change.fromPositions], ["fromNormal", change.fromNormals]);
    for (const [name, values] of news) {
      const count = name === "index" ? change.triangles : change.vertices;
      const runs = name === "index" ? change.faceRuns : change.vertexRuns;
      const part = this.#parts.get(name);
      if (part) yield* copy(part, values, runs);
      if (this.#gl) yield* this.#array(name, values, part?.width ?? 4, count).stage(values, kSlice);
    }
    yield true;
    this.#vertices = change.vertices;
    this.#triangles = change.triangles;
    this.#commit(news.map(([name]) => name), change.vertexRuns, change.faceRuns);
  }

  /** All vertices have arrived: what they came from is given back. */
  settle(): void {
    if (!this.#gpu.has("fromPosition")) return;
    for (const name of ["fromPosition", "fromNormal"] as const) {
      this.#gpu.get(name)?.dispose();
      this.#gpu.delete(name);
    }
    this.#describe();
  }

  dispose(): void {
    for (const array of this.#gpu.values()) array.dispose();
    this.#gpu.clear();
  }

  #array(name: Name, { BYTES_PER_ELEMENT }: Numbers, width: number, count: number): GpuArray {
    const known = this.#gpu.get(name);
    if (known) return known;
    const target = this.#parts.get(name)?.target ?? "ARRAY_BUFFER";
    const made = new GpuArray(this.#gl as WebGL2RenderingContext, target, count * width * BYTES_PER_ELEMENT);
    this.#gpu.set(name, made);
    return made;
  }

  #commit(names: Name[], vertexRuns: Uint32Array, faceRuns: Uint32Array): void {
    for (const name of this.#gl ? names : []) {
      const part = this.#parts.get(name);
      const bytes = part ? part.width * part.values.BYTES_PER_ELEMENT : name === "fromPosition" ? 16 : 8;
      const index = name === "index";
      this.#gpu.get(name)?.commit(index ? faceRuns : vertexRuns, bytes, index ? this.#triangles : this.#vertices);
    }
    this.#describe();
  }

  /** Tells the geometry of the present state. Fresh attributes each time: three.js asks for the buffers of those that it does not know. */
  #describe(): void {
    const { geometry } = this;
    ++this.#version;
    for (const [name, { values, width, type }] of this.#parts) {
      const index = name === "index";
      const part = values.subarray(0, width * (index ? this.#triangles : this.#vertices));
      const attribute = new MirroredAttribute(part, index ? 1 : width, this.#gpu.get(name)?.buffer, type);
      attribute.version = this.#version; // so three's wireframe knows that the index is another one
      if (index) geometry.setIndex(attribute);
      else geometry.setAttribute(name, attribute);
    }
    this.#describeOrigins();
    geometry.setDrawRange(0, this.#gpu.size > 0 ? 3 * this.#triangles : -1); // three.js draws even 0, which needs buffers
  }

  #describeOrigins(): void {
    const { FLOAT, SHORT } = WebGL2RenderingContext;
    for (const [name, type, size] of [["fromPosition", FLOAT, 4], ["fromNormal", SHORT, 2]] as const) {
      const buffer = this.#gpu.get(name)?.buffer;
      if (!buffer) {
        this.geometry.deleteAttribute(name);
        continue;
      }
      const attribute = Object.assign(new GLBufferAttribute(buffer, type, 4, size, this.#vertices), { normalized: type === SHORT });
      this.geometry.setAttribute(name, attribute as unknown as BufferAttribute);
    }
  }
}

/** Puts the values of `runs`, which lie one behind the other, to their places. */
function* copy({ values, width }: Part, news: Numbers, runs: Uint32Array): Steps {
  const slice = Math.ceil(kSlice / values.BYTES_PER_ELEMENT);
  for (let i = 0, from = 0; i < runs.length; i += 2) {
    const to = width * (runs[i] as number), count = width * (runs[i + 1] as number);
    for (let begin = 0; begin < count; begin += slice) {
      values.set(news.subarray(from + begin, from + Math.min(begin + slice, count)), to + begin);
      yield false;
    }
    from += count;
  }
}
