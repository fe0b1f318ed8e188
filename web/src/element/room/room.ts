// SPDX-License-Identifier: Apache-2.0
// The room that glossy and metallic surfaces reflect. It is computed once for all models of a page. This module is loaded
// only for a textured model, after its first picture.
import { CubeUVReflectionMapping, DataTexture, HalfFloatType, LinearFilter, RGBAFormat, type Mapping } from "three";
import { kMapHeight, kMapWidth } from "./environment-map.ts";
import workerText from "./worker.ts?text";

let texels: Promise<Uint16Array<ArrayBuffer>> | undefined;

/** Returns a new environment for a scene of three.js. The caller disposes of it. Rejects if the page may not start workers. */
export async function roomEnvironment(): Promise<DataTexture> {
  const room = new DataTexture(await (texels ??= compute()), kMapWidth, kMapHeight, RGBAFormat, HalfFloatType);
  room.mapping = CubeUVReflectionMapping as unknown as Mapping; // a value that the types of three.js do not list
  room.minFilter = room.magFilter = LinearFilter;
  room.needsUpdate = true;
  return room;
}

function compute(): Promise<Uint16Array<ArrayBuffer>> {
  const url = URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
  const worker = new Worker(url);
  URL.revokeObjectURL(url);
  return new Promise<Uint16Array<ArrayBuffer>>((resolve, reject) => {
    worker.onmessage = ({ data }: MessageEvent<Uint16Array<ArrayBuffer>>) => resolve(data);
    worker.onerror = ({ message }) => reject(new Error(message));
  }).finally(() => worker.terminate());
}
