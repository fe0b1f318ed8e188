// SPDX-License-Identifier: Apache-2.0
// New vertices part from their parents, and old ones leave their places, over a quarter of a second
// instead of popping: in the vertex shader, by attributes that are there only meanwhile.
import type { Material } from "three";
import { evenOutline } from "./outline.ts";

const kDuration = 250; // milliseconds
/** Changes under way at once; when there are more, the oldest ends early. */
const kChanges = 16;

const kDeclarations = `
attribute vec4 fromPosition; // w: number of the change that brought it, or 0
attribute vec4 fromNormal;
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

  /** Makes `material` draw vertices on their way. */
  apply(material: Material): void {
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, { newestChange: this.#newest, changeProgress: this.#progress });
      shader.vertexShader = `${kDeclarations}\n` + shader.vertexShader
        .replace("#include <beginnormal_vertex>", `#include <beginnormal_vertex>
          objectNormal = mix(fromNormal.xyz, objectNormal, morphed());`)
        .replace("#include <begin_vertex>", `#include <begin_vertex>
          transformed = mix(fromPosition.xyz, transformed, morphed());`);
      shader.fragmentShader = evenOutline(shader.fragmentShader);
    };
  }

  begin(change: number, now: number): void {
    this.#began.set(change, now);
    this.#newest.value = change;
    this.#progress.value[change % kChanges] = 0;
  }

  /** Sets the vertices to where they are at `now`. False once all have arrived. */
  advance(now: number): boolean {
    for (const [change, began] of this.#began) {
      const t = Math.min((now - began) / kDuration, 1);
      if (this.#newest.value - change < kChanges) this.#progress.value[change % kChanges] = t * t * (3 - 2 * t);
      if (t === 1) this.#began.delete(change);
    }
    if (this.#began.size === 0) this.#newest.value = -1; // without attributes the shader reads (0, 0, 0, 1)
    return this.#began.size > 0;
  }
}
