// SPDX-License-Identifier: Apache-2.0
// Typed interface to the C++ decoder and planner (codec/wasm). Each model has its own WebAssembly
// instance. Closing a model therefore frees all its memory, and a fault in one model cannot affect
// another.
import { kAttributes, kSemantics } from "./attributes.ts";
import {
  DamagedError, ModelError, type CameraView, type ModelInfo, type PictureRole, type Surface, type TextureInfo, type Want,
} from "./types.ts";

type Pointer = number;

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  allocate(size: number): Pointer;
  release(pointer: Pointer): void;
  error_text(): Pointer;
  header_length(data: Pointer, size: number): number;
  model_open(data: Pointer, size: number): Pointer;
  summary(model: Pointer): Pointer;
  summary_length(model: Pointer): number;
  unit(model: Pointer): Pointer;
  chunk_hash(model: Pointer, chunk: number): Pointer;
  check_picture(model: Pointer, picture: number, data: Pointer, size: number): number;
  picture_hash(model: Pointer, picture: number): Pointer;
  check_base(model: Pointer, data: Pointer, size: number): number;
  check_atlas(model: Pointer, data: Pointer, size: number): number;
  start(model: Pointer, base: Pointer, baseSize: number, atlas: Pointer, atlasSize: number): number;
  want(model: Pointer, kind: number, value: number): number;
  want_view(model: Pointer, numbers: Pointer): number;
  next_chunk(model: Pointer): number;
  check_chunk(model: Pointer, chunk: number, data: Pointer, size: number): number;
  apply(model: Pointer, chunk: number, data: Pointer, size: number): number;
  trim(model: Pointer): number;
  bytes_held(model: Pointer): number;
  parent_of(model: Pointer, vertex: number): number;
  vertex_count(model: Pointer): number;
  face_count(model: Pointer): number;
  display(model: Pointer): void;
  next_vertices(model: Pointer): number;
  next_faces(model: Pointer): number;
  positions(model: Pointer): Pointer;
  normals(model: Pointer): Pointer;
  indices(model: Pointer): Pointer;
  attribute_values(model: Pointer, index: number): Pointer;
  texture_coordinates(model: Pointer): Pointer;
}

/**
 * The picture roles and alpha modes, in the order of the enumerations in codec/format/manifest.h
 * and codec/mesh/texturing.h.
 */
const kRoles: readonly PictureRole[] = ["colour", "normal", "surface", "emission"];
const kAlphaModes: readonly TextureInfo["alphaMode"][] = ["opaque", "mask", "blend"];

export class Decoder {
  protected readonly wasm: Exports;
  protected model: Pointer = 0;
  #info: ModelInfo | undefined;
  #parents = new Uint32Array(0);
  #known = 0; // number of vertices whose parent has been recorded

  protected constructor(instance: WebAssembly.Instance) {
    this.wasm = instance.exports as unknown as Exports;
    this.wasm._initialize();
  }

  static async create(module: WebAssembly.Module): Promise<Decoder> {
    return new this(await WebAssembly.instantiate(module, {}));
  }

  /** Returns the length of the header in bytes, given the first bytes of the file. */
  headerLength(bytes: Uint8Array): number {
    const length = this.#lend(bytes, (data, size) => this.wasm.header_length(data, size));
    if (length < 0) throw this.#error();
    return length;
  }

  open(header: Uint8Array): ModelInfo {
    this.model = this.#lend(header, (data, size) => this.wasm.model_open(data, size));
    if (this.model === 0) throw this.#error();
    this.#info = this.#readInfo();
    return this.#info;
  }

  checkBase(bytes: Uint8Array): void {
    const fits = this.#lend(bytes, (data, size) => this.wasm.check_base(this.model, data, size));
    if (!fits) throw new DamagedError(this.#error().message);
  }

  checkAtlas(bytes: Uint8Array): void {
    const fits = this.#lend(bytes, (data, size) => this.wasm.check_atlas(this.model, data, size));
    if (!fits) throw new DamagedError(this.#error().message);
  }

  /** Throws DamagedError if the picture's SHA-256 is wrong. The picture should then be fetched again. */
  checkPicture(picture: number, bytes: Uint8Array): void {
    const fits = this.#lend(bytes, (data, size) => this.wasm.check_picture(this.model, picture, data, size));
    if (!fits) throw new DamagedError(this.#error().message);
  }

  /**
   * Starts at the base mesh, given its checked Draco buffer. `atlas` holds its coded texture coordinates. It
   * is empty if the model has no texture.
   */
  start(base: Uint8Array, atlas: Uint8Array): void {
    const started = this.#lend(base, (data, size) =>
      this.#lend(atlas, (coded, atlasSize) => this.wasm.start(this.model, data, size, coded, atlasSize)));
    if (!started) throw this.#error();
    if (this.#info) this.#info.centre = this.#readInfo().centre;
    this.#adopt();
  }

  /** Sets the detail target. Returns true if the surface was reset to the base mesh to reach it. */
  want(want: Want): boolean {
    const answer = "view" in want ? this.#wantView(want.view) : this.#wantAmount(want);
    if (answer < 0) throw this.#error();
    if (answer === 1) this.#known = 0;
    this.#adopt();
    return answer === 1;
  }

  #wantView({ camera, fov, width, height, pixels, bytes = Infinity, triangles = Infinity }: CameraView): number {
    const numbers = Float64Array.of(...camera.slice(0, 16), fov, width, height, pixels, bytes, triangles);
    if (numbers.length !== 22) throw new ModelError("the camera must have 16 numbers");
    return this.#lend(numbers, (data) => this.wasm.want_view(this.model, data));
  }

  #wantAmount(want: Exclude<Want, { view: CameraView }>): number {
    const [kind, value] =
      "triangles" in want ? [0, want.triangles]
      : "bytes" in want ? [1, want.bytes]
      : "error" in want ? [2, want.error]
      : [3, want.level];
    return this.wasm.want(this.model, kind, value);
  }

  /**
   * Returns the next chunk that the detail target needs, and marks it as requested. Returns
   * undefined if there is none.
   */
  nextChunk(): number | undefined {
    const chunk = this.wasm.next_chunk(this.model);
    return chunk < 0 ? undefined : chunk;
  }

  /** Throws DamagedError if the chunk's SHA-256 is wrong. The chunk should then be fetched again. */
  checkChunk(chunk: number, bytes: Uint8Array): void {
    const fits = this.#lend(bytes, (data, size) => this.wasm.check_chunk(this.model, chunk, data, size));
    if (!fits) throw new DamagedError(this.#error().message);
  }

  /**
   * Applies a checked chunk. Throws ModelError if the content is invalid; the next want() then
   * starts from the base mesh again.
   */
  apply(chunk: number, bytes: Uint8Array): void {
    const applied = this.#lend(bytes, (data, size) => this.wasm.apply(this.model, chunk, data, size));
    if (!applied) throw this.#error();
    this.#adopt();
  }

  /**
   * For each vertex, the vertex that was split to create it. Vertices of the base mesh and of inserted
   * components are their own parents.
   */
  get parents(): Uint32Array {
    return this.#parents;
  }

  /** Records the parents of the vertices that were added since the last call. */
  #adopt(): void {
    const count = this.wasm.vertex_count(this.model);
    if (count > this.#parents.length) {
      const longer = new Uint32Array(Math.max(count, 2 * this.#parents.length));
      longer.set(this.#parents);
      this.#parents = longer;
    }
    for (; this.#known < count; ++this.#known) this.#parents[this.#known] = this.wasm.parent_of(this.model, this.#known);
  }

  /** Undoes the vertex splits beyond the detail target. Must be called after the target is reached. */
  trim(): void {
    this.wasm.trim(this.model);
  }

  get bytesHeld(): number {
    return this.wasm.bytes_held(this.model);
  }

  /** Size of the WebAssembly memory, in pages of 64 KiB. */
  get pages(): number {
    return this.wasm.memory.buffer.byteLength >> 16;
  }

  surface(): Surface {
    const wasm = this.wasm, model = this.model;
    const vertices = wasm.vertex_count(model);
    const positions = new Float32Array(3 * vertices), normals = new Int16Array(4 * vertices);
    const attributes = (this.#info?.attributes ?? []).map((semantic) => (
      { semantic, values: new Uint16Array(kAttributes[semantic].width * vertices) }));
    const coordinates = this.#info?.texture && new Float32Array(2 * vertices);
    this.#eachPiece((buffer, at, count) => {
      coordinates?.set(new Float32Array(buffer, wasm.texture_coordinates(model), 2 * count), 2 * at);
      positions.set(new Float32Array(buffer, wasm.positions(model), 3 * count), 3 * at);
      normals.set(new Int16Array(buffer, wasm.normals(model), 4 * count), 4 * at);
      attributes.forEach(({ semantic, values }, i) => {
        const { bytes, width, shown } = kAttributes[semantic];
        values.set(shown(new Uint8Array(buffer, wasm.attribute_values(model, i), bytes * count)), width * at);
      });
    });
    const indices = this.#faces();
    const surface = { triangles: indices.length / 3, vertices, bytes: this.bytesHeld, positions, normals, attributes, indices };
    return coordinates ? { ...surface, coordinates } : surface;
  }

  /**
   * Reads the displayed vertices in pieces. Calls `use` for each piece of `count` vertices,
   * starting at vertex `at`.
   */
  #eachPiece(use: (buffer: ArrayBuffer, at: number, count: number) => void): void {
    const wasm = this.wasm;
    wasm.display(this.model);
    for (let at = 0, count; (count = wasm.next_vertices(this.model)) > 0; at += count) {
      use(wasm.memory.buffer, at, count);
    }
  }

  /** Reads the faces of the surface whose vertices #eachPiece has read. */
  #faces(): Uint32Array {
    const wasm = this.wasm;
    const faces = new Uint32Array(3 * wasm.face_count(this.model));
    for (let at = 0, count; (count = wasm.next_faces(this.model)) > 0; at += count) {
      faces.set(new Uint32Array(wasm.memory.buffer, wasm.indices(this.model), 3 * count), 3 * at);
    }
    return faces;
  }

  #lend<T>(array: Uint8Array | Float64Array, use: (data: Pointer, size: number) => T): T {
    const data = this.wasm.allocate(Math.max(array.byteLength, 1));
    if (data === 0) throw new ModelError("the model is too large for this browser's memory");
    try {
      const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
      new Uint8Array(this.wasm.memory.buffer).set(bytes, data);
      return use(data, array.byteLength);
    } finally {
      this.wasm.release(data);
    }
  }

  #error(): ModelError {
    return new ModelError(this.#text(this.wasm.error_text()));
  }

  #text(pointer: Pointer): string {
    const bytes = new Uint8Array(this.wasm.memory.buffer);
    return new TextDecoder().decode(bytes.slice(pointer, bytes.indexOf(0, pointer)));
  }

  /** Reads the model's summary. BrowserModel::summary (codec/wasm/browser_model.h) documents its layout. */
  #readInfo(): ModelInfo {
    const wasm = this.wasm;
    const pointer = wasm.summary(this.model);
    const numbers = new Float64Array(wasm.memory.buffer, pointer, wasm.summary_length(this.model)).slice();
    const at = (i: number) => numbers[i] ?? 0;
    const kFixed = 11, kLevel = 5, kChunk = 4;
    const levels = Array.from({ length: at(0) }, (_, i) => {
      const k = kFixed + kLevel * i;
      return { vertices: at(k), faces: at(k + 1), maxError: at(k + 2), rmsError: at(k + 3), cumulativeBytes: at(k + 4) };
    });
    const chunks = Array.from({ length: at(1) }, (_, i) => {
      const k = kFixed + kLevel * levels.length + kChunk * i;
      return { level: at(k), region: at(k + 1), offset: at(k + 2), length: at(k + 3), sha256: this.#hash(wasm.chunk_hash(this.model, i)) };
    });
    const texture = this.#readTexture(numbers.subarray(kFixed + kLevel * levels.length + kChunk * chunks.length));
    return {
      levels,
      chunks,
      baseOffset: at(2),
      baseLength: at(3),
      fileBytes: at(4),
      attributes: kSemantics.filter((_, i) => (at(5) >> i) & 1),
      bits: at(6),
      step: at(7),
      unit: this.#text(wasm.unit(this.model)),
      centre: [at(8), at(9), at(10)],
      ...(texture && { texture }),
    };
  }

  /**
   * Reads the part of the summary that describes the texture. This part is empty if the model has
   * no texture.
   */
  #readTexture(numbers: Float64Array): TextureInfo | undefined {
    if (numbers.length === 0) return undefined;
    const at = (i: number) => numbers[i] ?? 0;
    const kFixed = 8, kPicture = 4;
    return {
      atlasOffset: at(0),
      atlasLength: at(1),
      alphaMode: kAlphaModes[at(2)] ?? "opaque",
      alphaCutoff: at(3),
      isDoubleSided: at(4) === 1,
      isUnlit: at(5) === 1,
      pictures: Array.from({ length: at(6) }, (_, i) => {
        const k = kFixed + kPicture * i;
        return {
          role: kRoles[at(k)] ?? "colour", side: at(k + 1), offset: at(k + 2), length: at(k + 3),
          sha256: this.#hash(this.wasm.picture_hash(this.model, i)),
        };
      }),
      inHead: at(7),
    };
  }

  #hash(pointer: Pointer): string {
    const digest = new Uint8Array(this.wasm.memory.buffer, pointer, 32);
    return Array.from(digest, (byte) => byte.toString(16).padStart(2, "0")).join("");
  }
}
