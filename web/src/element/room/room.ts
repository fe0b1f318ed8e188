// SPDX-License-Identifier: Apache-2.0
// The room that glossy and metallic surfaces reflect. It is computed once for all models of a page. This module is loaded
// only for a textured model, after its first picture.
import { DataTexture, EquirectangularReflectionMapping, HalfFloatType, LinearFilter, RGBAFormat, ShaderChunk, type Mapping } from "three";
import { kMapHeight, kMapWidth, kPlainHeight, kPlainWidth } from "./environment-map.ts";
import workerText from "./worker.ts?text";

/**
 * CubeUVReflectionMapping of three.js. Newer releases have neither this constant nor the layout; they blur a plain map themselves, which
 * takes longer.
 */
const kPrefilteredMapping = 306 as Mapping;
const readsPrefiltered = "cube_uv_reflection_fragment" in ShaderChunk;

let texels: Promise<Uint16Array<ArrayBuffer>> | undefined;

/** Returns a new environment for a scene of three.js. The caller disposes of it. Rejects if the page may not start workers. */
export async function roomEnvironment(): Promise<DataTexture> {
  const [width, height] = readsPrefiltered ? [kMapWidth, kMapHeight] : [kPlainWidth, kPlainHeight];
  const room = new DataTexture(await (texels ??= compute()), width, height, RGBAFormat, HalfFloatType);
  room.mapping = readsPrefiltered ? kPrefilteredMapping : EquirectangularReflectionMapping;
  room.minFilter = room.magFilter = LinearFilter;
  room.needsUpdate = true;
  return room;
}

function compute(): Promise<Uint16Array<ArrayBuffer>> {
  const url = URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
  const worker = new Worker(url, { name: readsPrefiltered ? "prefiltered" : "plain" });
  URL.revokeObjectURL(url);
  return new Promise<Uint16Array<ArrayBuffer>>((resolve, reject) => {
    worker.onmessage = ({ data }: MessageEvent<Uint16Array<ArrayBuffer>>) => resolve(data);
    worker.onerror = ({ message }) => reject(new Error(message));
  }).finally(() => worker.terminate());
}
