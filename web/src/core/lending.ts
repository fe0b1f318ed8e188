// SPDX-License-Identifier: Apache-2.0
// Buffers that go to the page with a block each and come back empty: however large a change is, no
// more than these are on the way, and nobody's garbage collector hears of them.
import { kBlockBytes } from "./change.ts";

/** At most on the way at once: 4 MB. */
const kBuffers = 64;

export class Lending {
  readonly #idle: ArrayBuffer[] = [];
  #made = 0;
  #closed = false;
  #wake: (() => void) | undefined;

  /** A buffer as soon as there is one; undefined once this is closed. */
  async borrow(): Promise<ArrayBuffer | undefined> {
    while (!this.#closed && this.#idle.length === 0 && this.#made === kBuffers) {
      await new Promise<void>((resolve) => (this.#wake = resolve));
    }
    if (this.#closed) return undefined;
    const idle = this.#idle.pop();
    if (!idle) ++this.#made;
    return idle ?? new ArrayBuffer(kBlockBytes);
  }

  giveBack(buffers: ArrayBuffer[]): void {
    this.#idle.push(...buffers);
    this.#wake?.();
  }

  close(): void {
    this.#closed = true;
    this.#wake?.();
  }
}
