// SPDX-License-Identifier: Apache-2.0
// At an outline a back face may win pixels from the front face whose edge it shares. Turned towards the viewer,
// as the inside of an open scan is, it would speckle the outline: there its normal stays as it is.

/** A fragment shader of three.js; `0.2` is the cosine of how far a normal at the outline turns away. */
export function evenOutline(shader: string): string {
  return shader.replace("#include <normal_fragment_begin>", `$&
#if defined STANDARD && !defined FLAT_SHADED
if (!gl_FrontFacing && dot(normal, normalize(vViewPosition)) < 0.2) normal = -normal;
#endif`);
}
