// SPDX-License-Identifier: Apache-2.0
// Avoids speckles at silhouettes, where a back face may cover pixels of an adjacent front face.
// three.js flips the normals of back faces towards the viewer, which is right for the inside of an
// open scan but makes silhouettes speckled. This patch keeps the original normals of back faces
// near a silhouette.

/**
 * Returns the patched source of a three.js fragment shader. A back face counts as near a silhouette
 * if the cosine of the angle between its flipped normal and the direction to the viewer is below
 * 0.2.
 */
export function evenOutline(shader: string): string {
  return shader.replace("#include <normal_fragment_begin>", `$&
#if defined STANDARD && !defined FLAT_SHADED
if (!gl_FrontFacing && dot(normal, normalize(vViewPosition)) < 0.2) normal = -normal;
#endif`);
}
