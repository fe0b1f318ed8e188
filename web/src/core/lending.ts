// SPDX-License-Identifier: Apache-2.0
// Pool of the buffers that carry blocks to the page. The page returns the buffers. The pool bounds
// the memory in transit for changes of any size, and avoids allocating a buffer for each block.
import { kBlockBytes } from "./change.ts";

/** Maximum number of buffers in transit. Together they have 4 MiB. */
const kBuffers = 64;

export class Lending {
  readonly #idle: ArrayBuffer[] = [];
  #made = 0;
  #isClosed = false;
  #wake: (() => void) | undefined;

  /** Resolves to a buffer when one is free. Resolves to undefined if the pool is closed. */
  async borrow(): Promise<ArrayBuffer | undefined> {
    while (!this.#isClosed && this.#idle.length === 0 && this.#made === kBuffers) {
      await new Promise<void>((resolve) => (this.#wake = resolve));
    }
    if (this.#isClosed) return undefined;
    const idle = this.#idle.pop();
    if (!idle) ++this.#made;
    return idle ?? new ArrayBuffer(kBlockBytes);
  }

  giveBack(buffers: ArrayBuffer[]): void {
    this.#idle.push(...buffers);
    this.#wake?.();
  }

  close(): void {
    this.#isClosed = true;
    this.#wake?.();
  }
}
