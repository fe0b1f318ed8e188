// SPDX-License-Identifier: Apache-2.0
// A page of three.js that loads models with the npm package's loader and with GLTFLoader, and draws them.
import { AmbientLight, Box3, DirectionalLight, PerspectiveCamera, Scene, Sphere, Vector3, WebGLRenderer } from "three";
import { DRACOLoader } from "three/examples/jsm/loaders/DRACOLoader.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { ProgressiveMeshLoader } from "@vitrine/progressive-mesh";

const kPixels = 400;
const renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(kPixels, kPixels);
document.body.append(renderer.domElement);
const gltf = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).setDRACOLoader(new DRACOLoader().setDecoderPath("/draco/"));

/**
 * Draws an object alone. Returns its number of triangles, its size, and how many pixels it covers,
 * in total, in red and in blue.
 */
function shown(object) {
  const scene = new Scene().add(object, new AmbientLight(0xffffff, 1), new DirectionalLight(0xffffff, 3));
  scene.updateMatrixWorld(true);
  const box = new Box3().setFromObject(object, true), { center, radius } = box.getBoundingSphere(new Sphere());
  const camera = new PerspectiveCamera(35, 1, radius / 100, radius * 100);
  camera.position.copy(center).z += 3.5 * radius;
  camera.lookAt(center);
  renderer.render(scene, camera);
  const { triangles } = renderer.info.render, context = renderer.getContext(), pixels = new Uint8Array(4 * kPixels * kPixels);
  context.readPixels(0, 0, kPixels, kPixels, context.RGBA, context.UNSIGNED_BYTE, pixels);
  let covered = 0, red = 0, blue = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    const [r, g, b] = pixels.subarray(i, i + 3);
    covered += r + g + b > 0;
    red += r > 2 * b;
    blue += b > 2 * r;
  }
  return { triangles, size: box.getSize(new Vector3()).toArray(), covered, red, blue };
}

window.client = {
  async glb(url) {
    return shown((await gltf.loadAsync(url)).scene);
  },
  async progressive(url) {
    const mesh = await new ProgressiveMeshLoader().loadAsync(url), base = shown(mesh).triangles;
    await mesh.refine({ level: mesh.info.levels.length - 1 });
    return { base, ...shown(mesh) };
  },
};
