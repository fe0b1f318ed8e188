// SPDX-License-Identifier: Apache-2.0
// A double-buffered array in GPU memory. The GPU copies the current state to the next one. New data
// are uploaded in slices over several frames. Then the next state replaces the current one.
// Therefore, a large change needs no long task, and a partial change is never drawn.

/**
 * Work in steps. Each yielded value says when the next step may run: immediately, in the next
 * frame, or when more data have arrived.
 */
export type Steps = Generator<"continue" | "next frame" | "wait", void>;

export type BufferTarget = "ARRAY_BUFFER" | "ELEMENT_ARRAY_BUFFER";

export class GpuArray {
  #buffer: WebGLBuffer | undefined;
  #bytes = 0;
  #next: WebGLBuffer | undefined;
  #nextBytes = 0;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly target: BufferTarget,
  ) {}

  /** The buffer with the current state. Undefined before the first commit(). */
  get buffer(): WebGLBuffer | undefined {
    return this.#buffer;
  }

  /** Size of the current state. */
  get bytes(): number {
    return this.#bytes;
  }

  /** Starts the next state, `bytes` in size. It is a copy of the current state, padded with zeros. */
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

  /** Writes `values` into the next state, from byte number `at` on. */
  put(at: number, values: ArrayBufferView): void {
    const { gl } = this;
    gl.bindBuffer(gl.COPY_WRITE_BUFFER, this.#next as WebGLBuffer);
    gl.bufferSubData(gl.COPY_WRITE_BUFFER, at, values);
  }

  /** Replaces the current state by the next one. */
  commit(): void {
    this.gl.deleteBuffer(this.#buffer ?? null);
    this.#buffer = this.#next;
    this.#bytes = this.#nextBytes;
    this.#next = undefined;
  }

  dispose(): void {
    for (const buffer of [this.#buffer, this.#next]) this.gl.deleteBuffer(buffer ?? null);
  }

  /**
   * Allocates a buffer of zeros. Binds it to its target, because WebGL fixes a buffer's type at the
   * first binding. Does not change the caller's vertex array object.
   */
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
