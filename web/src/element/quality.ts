// SPDX-License-Identifier: Apache-2.0
// Estimates the cost of each choice of detail: the bytes from the manifest, the seconds from the
// measured throughput.
import type { Level, ModelInfo } from "../core/types.ts";

/** Factor by which the weight of earlier samples decreases with each new sample. */
const kMemory = 0.8;

/** Measures the throughput of a connection while new data arrive. */
export class Throughput {
  #bytes = 0;
  #seconds = 0;
  #most = 0; // size in bytes of the largest state so far; smaller states need no download
  #since: number | undefined;

  /**
   * Starts a measurement at the time `now`, in milliseconds. The time since the previous
   * measurement does not count.
   */
  begin(now: number): void {
    this.#since = now;
  }

  /** Records that a state of `bytes` in total has arrived at the time `now`, in milliseconds. */
  sample(bytes: number, now: number): void {
    const since = this.#since ?? now;
    this.#since = now;
    if (bytes <= this.#most) return;
    if (now > since) {
      this.#bytes = kMemory * this.#bytes + bytes - this.#most;
      this.#seconds = kMemory * this.#seconds + (now - since) / 1000;
    }
    this.#most = bytes;
  }

  get held(): number {
    return this.#most;
  }

  /**
   * Returns the estimated seconds until a state of `bytes` is downloaded. Returns 0 if it is
   * already downloaded, and undefined before the first measurement.
   */
  secondsTo(bytes: number): number | undefined {
    if (bytes <= this.#most) return 0;
    return this.#seconds > 0 ? ((bytes - this.#most) * this.#seconds) / this.#bytes : undefined;
  }
}

/** Returns the index of the first level with more than `triangles` faces, or undefined if no level has more. */
export function nextLevel({ levels }: Pick<ModelInfo, "levels">, triangles: number): number | undefined {
  const next = levels.findIndex(({ faces }) => faces > triangles);
  return next < 0 ? undefined : next;
}

/**
 * Returns the finest level that is complete when a uniformly refined model has `triangles` faces.
 */
export function completeLevel({ levels }: Pick<ModelInfo, "levels">, triangles: number): Level {
  return levels.filter(({ faces }) => faces <= triangles).at(-1) ?? (levels[0] as Level);
}
