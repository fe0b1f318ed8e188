// SPDX-License-Identifier: Apache-2.0
// Changes the colour that a material's fragment shader has computed, before tone mapping.
import type { Material, WebGLProgramParametersWithUniforms } from "three";

const patched = new WeakMap<Material, Map<string, string>>();

/**
 * Sets the GLSL statements called `name`, which may change gl_FragColor. An empty text removes them. Statements run in the
 * alphabetical order of their names.
 */
export function patchColour(material: Material, name: string, statements: string): void {
  const patches = patched.get(material) ?? patchable(material);
  if ((patches.get(name) ?? "") === statements) return;
  patches.set(name, statements);
  material.needsUpdate = true;
}

function patchable(material: Material): Map<string, string> {
  const patches = new Map<string, string>(), { onBeforeCompile, customProgramCacheKey } = material;
  const statements = () => [...patches].sort().map(([, text]) => text).join("\n");
  material.onBeforeCompile = (shader: WebGLProgramParametersWithUniforms, renderer) => {
    onBeforeCompile.call(material, shader, renderer);
    shader.fragmentShader = shader.fragmentShader.replace("#include <opaque_fragment>", (line) => `${line}\n${statements()}`);
  };
  material.customProgramCacheKey = () => customProgramCacheKey.call(material) + statements();
  patched.set(material, patches);
  return patches;
}
