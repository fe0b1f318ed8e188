// SPDX-License-Identifier: Apache-2.0
// Finds the point of the surface that is visible at a pixel, from the depth that the GPU renders
// at this pixel. Parts cut away by a section are therefore not picked.
import { DoubleSide, MeshDepthMaterial, RGBADepthPacking, Vector3, WebGLRenderTarget } from "three";
import type { Stage } from "../stage.ts";

/**
 * Unpacks a depth from 0 to 1 that three.js has packed into RGBA. The first three bytes are a
 * 24-bit number, most significant byte first. The fourth byte, divided by 255, is added to this
 * number as a fraction.
 */
export function unpackDepth([high = 0, middle = 0, low = 0, rest = 0]: Iterable<number>): number {
  return (high * 65536 + middle * 256 + low + rest / 255) / 2 ** 24;
}

/**
 * Returns the point of the surface at `x`, `y` (CSS pixels from the canvas's upper left corner), or
 * undefined if there is none.
 */
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
