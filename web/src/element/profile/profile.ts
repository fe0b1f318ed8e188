// SPDX-License-Identifier: Apache-2.0
// The profile of a surface along a straight cut: its heights above the line between two points, as the visitor sees it. The GPU
// draws the depth of the cut as one row of pixels, so the time does not depend on the number of triangles.
import { DoubleSide, Mesh, MeshDepthMaterial, PerspectiveCamera, RGBADepthPacking, Scene, Vector3, WebGLRenderTarget, type Sphere, type WebGLRenderer } from "three";

export interface Sample {
  /** Distance from the first point along the line, in model units. */
  distance: number;
  /** Height above the line, towards the visitor, in model units. Undefined if there is no surface. */
  height: number | undefined;
}

const kSamples = 512;

export interface Cut {
  from: Vector3;
  to: Vector3;
  /** A point on the visitor's side of the surface. */
  eye: Vector3;
}

/**
 * Returns the profile of `surface`, whose geometry must have a bounding sphere. Returns an empty list if the points
 * coincide or are in line with the eye.
 * `unpackDepth` converts four bytes of three.js' RGBADepthPacking to a depth from 0 to 1.
 */
export function profileOf(renderer: WebGLRenderer, surface: Mesh, { from, to, eye }: Cut, unpackDepth: (bytes: Iterable<number>) => number): Sample[] {
  const along = to.clone().sub(from), length = along.length(), { center, radius } = sphereOf(surface) ?? { center: from, radius: length };
  along.normalize();
  const up = eye.clone().sub(from);
  up.addScaledVector(along, -up.dot(along)).normalize();
  if (!(length > 0 && up.length() > 0.5)) return [];
  // The camera is above the surface and looks in the direction opposite to `up`. The line is at the
  // middle row of its picture.
  const above = radius + center.distanceTo(from), camera = new PerspectiveCamera();
  camera.position.copy(from).addScaledVector(up, above);
  camera.up.copy(up).cross(along);
  camera.lookAt(from);
  camera.updateMatrixWorld();
  camera.projectionMatrix.makeOrthographic(0, length, length / kSamples / 2, -length / kSamples / 2, 0, 2 * above);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  return depths(renderer, surface, camera).map((bytes, i) => ({
    distance: ((i + 0.5) / kSamples) * length,
    height: bytes.some((byte) => byte > 0) ? above - 2 * above * unpackDepth(bytes) : undefined,
  }));
}

/** Returns the bounding sphere of a mesh in world coordinates. */
function sphereOf({ geometry: { boundingSphere }, matrixWorld }: Mesh): Sphere | undefined {
  return boundingSphere?.clone().applyMatrix4(matrixWorld);
}

/** Draws one row of packed depths. Returns the four bytes of each pixel. */
function depths(renderer: WebGLRenderer, surface: Mesh, camera: PerspectiveCamera): Uint8Array[] {
  const target = new WebGLRenderTarget(kSamples, 1), material = new MeshDepthMaterial({ depthPacking: RGBADepthPacking, side: DoubleSide });
  const mesh = new Mesh(surface.geometry, material), bytes = new Uint8Array(4 * kSamples);
  mesh.frustumCulled = false;
  mesh.applyMatrix4(surface.matrixWorld);
  renderer.setRenderTarget(target);
  renderer.render(new Scene().add(mesh), camera);
  renderer.readRenderTargetPixels(target, 0, 0, kSamples, 1, bytes);
  renderer.setRenderTarget(null);
  target.dispose();
  material.dispose();
  return Array.from({ length: kSamples }, (_, i) => bytes.subarray(4 * i, 4 * i + 4));
}

/** Returns the samples as comma-separated values. `unit` may be empty. */
export function csvOf(samples: readonly Sample[], unit: string): string {
  const name = (text: string) => (unit ? `${text} [${unit}]` : text);
  const rows = samples.map(({ distance, height }) => [distance, height].map((value) => (value === undefined ? "" : Number(value.toPrecision(7)))).join(","));
  return [`${name("distance")},${name("height")}`, ...rows, ""].join("\r\n");
}

/** Size of the drawing in pixels. */
const kWidth = 320, kHeight = 140, kEdge = 14;

/**
 * Returns the profile as a drawing, in which heights and distances have the same scale if the profile then
 * fits. `lengthOf` formats a length.
 */
export function svgOf(samples: readonly Sample[], lengthOf: (value: number) => string): string {
  const heights = samples.flatMap(({ height }) => height ?? []), low = Math.min(...heights, 0), high = Math.max(...heights, 0);
  const length = samples.at(-1)?.distance ?? 1, across = (kWidth - 2 * kEdge) / length;
  const scale = Math.min(across, (kHeight - 3 * kEdge) / (high - low || length));
  const x = (distance: number) => (kEdge + across * distance).toFixed(1), y = (height: number) => (kEdge + scale * (high - height)).toFixed(1);
  const text = (value: number) => lengthOf(value).replace(/[&<>]/g, (letter) => `&#${letter.charCodeAt(0)};`);
  let isGap = true;
  const path = samples.map(({ distance, height }) => {
    if (height === undefined) return (isGap = true), "";
    const step = `${isGap ? "M" : "L"}${x(distance)} ${y(height)}`;
    isGap = false;
    return step;
  }).join("");
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${kWidth} ${kHeight}" font-family="sans-serif" font-size="12">` +
    `<path d="M${x(0)} ${y(0)}H${x(length)}" stroke="#8a8377" stroke-dasharray="4 4"/>` +
    `<path d="${path}" fill="none" stroke="#1f4e5f" stroke-width="2" stroke-linejoin="round"/>` +
    `<text x="${kEdge}" y="${kHeight - 8}" fill="#625d55">${text(length)}</text>` +
    `<text x="${kWidth - kEdge}" y="${kHeight - 8}" fill="#625d55" text-anchor="end">${text(low)} … ${text(high)}</text></svg>`;
}
