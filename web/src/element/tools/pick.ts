// SPDX-License-Identifier: Apache-2.0
// Which point of the surface is seen at a pixel: read from the depth that the GPU draws there, because the
// surface lies in its memory alone, and so that what is cut away does not count.
import { DoubleSide, MeshDepthMaterial, RGBADepthPacking, Vector3, WebGLRenderTarget } from "three";
import type { Stage } from "../stage.ts";

/** As three.js packs a depth from 0 to 1: 24 bits, highest byte first, and what remains of it in 255 parts. */
export function unpackDepth([high = 0, middle = 0, low = 0, rest = 0]: Iterable<number>): number {
  return (high * 65536 + middle * 256 + low + rest / 255) / 2 ** 24;
}

/** `x` and `y` in CSS pixels from the canvas' upper left corner. Undefined beside the model. */
export function pick({ parts: { renderer, scene, camera } }: Stage, x: number, y: number): Vector3 | undefined {
  const { clientWidth, clientHeight } = renderer.domElement;
  const target = new WebGLRenderTarget(1, 1), depth = new MeshDepthMaterial({ depthPacking: RGBADepthPacking, side: DoubleSide });
  const bytes = new Uint8Array(4);
  camera.setViewOffset(clientWidth, clientHeight, Math.floor(x), Math.floor(y), 1, 1);
  scene.overrideMaterial = depth;
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  renderer.readRenderTargetPixels(target, 0, 0, 1, 1, bytes);
  const hit = bytes.some((byte) => byte > 0) ? new Vector3(0, 0, 2 * unpackDepth(bytes) - 1).unproject(camera) : undefined;
  renderer.setRenderTarget(null);
  scene.overrideMaterial = null;
  camera.clearViewOffset();
  target.dispose();
  depth.dispose();
  return hit;
}
