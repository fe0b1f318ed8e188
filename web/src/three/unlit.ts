// SPDX-License-Identifier: Apache-2.0
// Makes a material with the define UNLIT show its colours without light, like MeshBasicMaterial.
// Without the define, the same material is lit, to show the form alone.

/** Returns the patched source of a three.js fragment shader. */
export function unlit(shader: string): string {
  return shader.replace("#include <opaque_fragment>", `
#ifdef UNLIT
outgoingLight = diffuseColor.rgb;
#endif
$&`);
}
