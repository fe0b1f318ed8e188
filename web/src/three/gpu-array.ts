// SPDX-License-Identifier: Apache-2.0
// An array in the GPU's memory that changes between two frames. Its next state is a copy that the
// GPU makes itself, into which what is new goes slice by slice, frame after frame, and which then
// takes the place of the present one. So a large change costs no long task, and nobody sees half of it.

/** Work in slices. After each step the next may follow at once, must have a frame of its own, or waits for more to come. */
export type Steps = Generator<"go on" | "next frame" | "wait", void>;

export type Target = "ARRAY_BUFFER" | "ELEMENT_ARRAY_BUFFER";

export class GpuArray {
  #buffer: WebGLBuffer | undefined;
  #bytes = 0;
  #next: WebGLBuffer | undefined;
  #nextBytes = 0;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly target: Target,
  ) {}

  /** The present state. */
  get buffer(): WebGLBuffer | undefined {
    return this.#buffer;
  }

  /** The next state will have so many bytes: those of the present one as far as they go, then zeros. */
  begin(bytes: number): void {
    const { gl } = this;
    gl.deleteBuffer(this.#next ?? null);
    this.#next = this.#allocate(bytes);
    this.#nextBytes = bytes;
    if (!this.#buffer) return;
    gl.bindBuffer(gl.COPY_READ_BUFFER, this.#buffer);
    gl.bindBuffer(gl.COPY_WRITE_BUFFER, this.#next);
    gl.copyBufferSubData(gl.COPY_READ_BUFFER, gl.COPY_WRITE_BUFFER, 0, 0, Math.min(bytes, this.#bytes));
  }

  /** Puts `values` into the next state, `at` bytes from its start. */
  put(at: number, values: ArrayBufferView): void {
    const { gl } = this;
    gl.bindBuffer(gl.COPY_WRITE_BUFFER, this.#next as WebGLBuffer);
    gl.bufferSubData(gl.COPY_WRITE_BUFFER, at, values);
  }

  /** The next state is the present one from now on. */
  commit(): void {
    this.gl.deleteBuffer(this.#buffer ?? null);
    this.#buffer = this.#next;
    this.#bytes = this.#nextBytes;
    this.#next = undefined;
  }

  dispose(): void {
    for (const buffer of [this.#buffer, this.#next]) this.gl.deleteBuffer(buffer ?? null);
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
