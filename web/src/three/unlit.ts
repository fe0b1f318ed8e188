// SPDX-License-Identifier: Apache-2.0
// Patches shaders: a material with the preprocessor definition UNLIT shows its colours without
// light, like MeshBasicMaterial. Without the definition, the same material is lit, to show the form
// alone.

/** Returns the patched source of a three.js fragment shader. */
export function unlit(shader: string): string {
  return shader.replace("#include <opaque_fragment>", `
#ifdef UNLIT
outgoingLight = diffuseColor.rgb;
#endif
$&`);
}
