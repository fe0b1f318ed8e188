// SPDX-License-Identifier: Apache-2.0
// Geomorphs avoid visible jumps. For a quarter of a second, new vertices move away from their
// parents' positions, and existing vertices move from their previous positions. The vertex shader
// interpolates between attributes that exist only during the morph.
import type { Material } from "three";
import { evenOutline } from "./outline.ts";
import { unlit } from "./unlit.ts";

const kDuration = 250; // duration of a morph, in milliseconds
/** Maximum number of changes that morph at the same time. If there are more, the oldest morph ends early. */
const kChanges = 16;

const kDeclarations = `
attribute vec4 fromPosition; // w: number of the change that moves the vertex, or 0
attribute vec4 fromNormal;
attribute vec2 fromCoordinate;
uniform float newestChange;
uniform float changeProgress[${kChanges}];
float morphed() {
  float age = newestChange - fromPosition.w;
  return fromPosition.w > 0. && age >= 0. && age < ${kChanges}. ? changeProgress[int(mod(fromPosition.w, ${kChanges}.) + .5)] : 1.;
}`;

export class Geomorph {
  readonly #newest = { value: -1 };
  readonly #progress = { value: new Float32Array(kChanges).fill(1) };
  readonly #began = new Map<number, number>();

  /** Changes the shader of `material` so that it draws vertices at their interpolated positions. */
  apply(material: Material): void {
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, { newestChange: this.#newest, changeProgress: this.#progress });
      shader.vertexShader = `${kDeclarations}\n` + shader.vertexShader
        .replace("#include <uv_vertex>", `
          #define uv mix(fromCoordinate, uv, morphed())
          #include <uv_vertex>
          #undef uv`)
        .replace("#include <beginnormal_vertex>", `#include <beginnormal_vertex>
          objectNormal = mix(fromNormal.xyz, objectNormal, morphed());`)
        .replace("#include <begin_vertex>", `#include <begin_vertex>
          transformed = mix(fromPosition.xyz, transformed, morphed());`);
      shader.fragmentShader = unlit(evenOutline(shader.fragmentShader));
    };
  }

  begin(change: number, now: number): void {
    this.#began.set(change, now);
    this.#newest.value = change;
    this.#progress.value[change % kChanges] = 0;
  }

  /**
   * Updates the progress of all morphs to the time `now`, in milliseconds. Returns false when all
   * morphs have finished.
   */
  advance(now: number): boolean {
    for (const [change, began] of this.#began) {
      const t = Math.min((now - began) / kDuration, 1);
      if (this.#newest.value - change < kChanges) this.#progress.value[change % kChanges] = t * t * (3 - 2 * t);
      if (t === 1) this.#began.delete(change);
    }
    // Without morphs, there are no `from…` attributes, and the shader reads (0, 0, 0, 1) in their
    // place. -1 makes the shader ignore that value.
    if (this.#began.size === 0) this.#newest.value = -1;
    return this.#began.size > 0;
  }
}
