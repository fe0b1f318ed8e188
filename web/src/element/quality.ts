// SPDX-License-Identifier: Apache-2.0
// What each choice of detail costs: bytes from the manifest, seconds from the line as measured.
import type { Level, ModelInfo } from "../core/types.ts";

/** How much of the past a sample leaves standing. */
const kMemory = 0.8;

/** Bytes a second of a line, measured while something new comes in. */
export class Throughput {
  #bytes = 0;
  #seconds = 0;
  #most = 0; // of a state so far: what is below is held, and costs nothing
  #since: number | undefined;

  /** `now` in milliseconds: the line has been idle until now. */
  begin(now: number): void {
    this.#since = now;
  }

  /** A state of `bytes` in all is there. */
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

  /** 0 for what is held, undefined as long as nothing has been measured. */
  secondsTo(bytes: number): number | undefined {
    if (bytes <= this.#most) return 0;
    return this.#seconds > 0 ? ((bytes - this.#most) * this.#seconds) / this.#bytes : undefined;
  }
}

/** The first level that is finer than `triangles`, or undefined at the finest. */
export function nextLevel({ levels }: Pick<ModelInfo, "levels">, triangles: number): number | undefined {
  const next = levels.findIndex(({ faces }) => faces > triangles);
  return next < 0 ? undefined : next;
}

/** The finest level of which all is there, in a model that is refined everywhere alike. */
export function completeLevel({ levels }: Pick<ModelInfo, "levels">, triangles: number): Level {
  return levels.filter(({ faces }) => faces <= triangles).at(-1) ?? (levels[0] as Level);
}
