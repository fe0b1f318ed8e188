// SPDX-License-Identifier: Apache-2.0
// Finds out whether a response contains content that visitors must not get.
import { createHash } from "node:crypto";

// Secret content is stored as windows: successive pieces of this many bytes. The PLY files of two models can share 16 bytes
// (a triangle and a part of the next one), so a window must be longer.
const kWindow = 32;

/**
 * Content that visitors must not get. Stores its adjacent windows of kWindow bytes, and therefore
 * recognises any 63 successive bytes of it.
 */
export class Secrets {
  #windows = new Set();
  #harmless = new Set(); // SHA-256 of contents found to be without secrets, because daemons often send the same content

  hide(content) {
    this.#harmless.clear();
    for (const window of windows(content, kWindow)) this.#windows.add(window);
  }

  reveal(content) {
    for (const window of windows(content, 1)) this.#windows.delete(window);
  }

  get size() {
    return this.#windows.size;
  }

  areIn(content) {
    const name = createHash("sha256").update(content).digest("hex");
    if (this.#harmless.has(name)) return false;
    for (const window of windows(content, 1)) if (this.#windows.has(window)) return true;
    this.#harmless.add(name);
    return false;
  }
}

function* windows(content, step) {
  const text = content.toString("latin1");
  for (let i = 0; i + kWindow <= text.length; i += step) yield text.slice(i, i + kWindow);
}
