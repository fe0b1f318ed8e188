// SPDX-License-Identifier: Apache-2.0
// Shades a surface by its mean curvature, without light and colour: ridges are bright, grooves are dark.

/** Curvature, multiplied by the model's radius, that is drawn halfway between grey and white. */
const kHalfway = 20;

/**
 * Returns GLSL for the fragment shader of a MeshStandardMaterial. `radius` is the model's radius in model units. The mean
 * curvature comes from the coefficients of the first (E, F, G) and second (e, f, g) fundamental form. Their derivatives are
 * differences between neighbouring pixels.
 */
export function curvatureShading(radius: number): string {
  return `{
    vec3 px = -dFdx(vViewPosition), py = -dFdy(vViewPosition), nx = dFdx(normal), ny = dFdy(normal);
    float E = dot(px, px), F = dot(px, py), G = dot(py, py), e = dot(px, nx), f = 0.5 * (dot(px, ny) + dot(py, nx)), g = dot(py, ny);
    float bend = ${(radius / kHalfway).toExponential()} * (e * G - 2.0 * f * F + g * E) / max(2.0 * (E * G - F * F), 1e-30);
    float shade = 0.5 + 0.5 * bend / (1.0 + abs(bend));
    gl_FragColor.rgb = vec3(pow(shade * (0.8 + 0.2 * abs(normal.z)), 2.2));
  }`;
}
