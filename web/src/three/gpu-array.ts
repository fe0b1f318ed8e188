// SPDX-License-Identifier: Apache-2.0
// An array in the GPU's memory that is never uploaded at once: changes are staged beside it slice
// by slice, frame after frame, and then the GPU copies them to their places between two frames. So
// a large change costs no long task, and nobody sees half of it.

/** Work in slices, one at each step; true where the next one is to have a frame of its own. */
export type Steps = Generator<boolean, void>;

export type Target = "ARRAY_BUFFER" | "ELEMENT_ARRAY_BUFFER";

/** Room for more that a growing array gets. */
const kGrowth = 2;

export class GpuArray {
  #buffer: WebGLBuffer;
  #bytes: number;
  #staged: WebGLBuffer | undefined;
  #lost = false;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly target: Target,
    bytes: number,
  ) {
    this.#bytes = bytes;
    this.#buffer = this.#allocate(bytes);
  }

  get buffer(): WebGLBuffer {
    return this.#buffer;
  }

  /** Uploads `values` beside the array, `slice` bytes at each step. */
  *stage(values: ArrayBufferView, slice: number): Steps {
    const { gl } = this;
    const staged = (this.#staged = this.#allocate(values.byteLength));
    for (let begin = 0; begin < values.byteLength && !this.#lost; begin += slice) {
      gl.bindBuffer(gl.COPY_WRITE_BUFFER, staged);
      const length = Math.min(slice, values.byteLength - begin);
      gl.bufferSubData(gl.COPY_WRITE_BUFFER, begin, new Uint8Array(values.buffer, values.byteOffset + begin, length));
      yield false;
    }
  }

  /** Puts what was staged into its places: `runs` are pairs of a first element and a number of them. */
  commit(runs: Uint32Array, elementBytes: number, elements: number): void {
    if (this.#lost) return;
    this.#reserve(elements * elementBytes);
    for (let i = 0, from = 0; i < runs.length; i += 2) {
      const to = (runs[i] as number) * elementBytes, size = (runs[i + 1] as number) * elementBytes;
      this.#copy(this.#staged as WebGLBuffer, from, this.#buffer, to, size);
      from += size;
    }
    this.#drop();
  }

  /** The context is lost, and all arrays with it: nothing more is asked of it. */
  abandon(): void {
    this.#lost = true;
  }

  dispose(): void {
    this.#drop();
    this.gl.deleteBuffer(this.#buffer);
  }

  #drop(): void {
    if (this.#staged) this.gl.deleteBuffer(this.#staged);
    this.#staged = undefined;
  }

  #reserve(bytes: number): void {
    if (bytes <= this.#bytes) return;
    const larger = this.#allocate(kGrowth * bytes);
    this.#copy(this.#buffer, 0, larger, 0, this.#bytes);
    this.gl.deleteBuffer(this.#buffer);
    this.#buffer = larger;
    this.#bytes = kGrowth * bytes;
  }

  #copy(from: WebGLBuffer, at: number, to: WebGLBuffer, where: number, size: number): void {
    const { gl } = this;
    gl.bindBuffer(gl.COPY_READ_BUFFER, from);
    gl.bindBuffer(gl.COPY_WRITE_BUFFER, to);
    gl.copyBufferSubData(gl.COPY_READ_BUFFER, gl.COPY_WRITE_BUFFER, at, where, size);
  }

  /** Zeros. A buffer is bound first as what it is for; the vertex array of whoever draws stays as it is. */
  #allocate(bytes: number): WebGLBuffer {
    const { gl } = this;
    const buffer = gl.createBuffer() as WebGLBuffer;
    const vertexArray = gl.getParameter(gl.VERTEX_ARRAY_BINDING) as WebGLVertexArrayObject | null;
    gl.bindVertexArray(null);
    gl.bindBuffer(gl[this.target], buffer);
    gl.bufferData(gl[this.target], Math.max(bytes, 4), gl.STATIC_DRAW);
    gl.bindBuffer(gl[this.target], null);
    gl.bindVertexArray(vertexArray);
    return buffer;
  }
}
