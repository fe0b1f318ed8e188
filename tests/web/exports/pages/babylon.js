// SPDX-License-Identifier: Apache-2.0
// Loads the GLB `source` with Babylon.js, which requests each level of detail by itself (MSFT_lod), from coarse to fine. Sets
// window.result once the finest level is shown.
import { ArcRotateCamera } from "@babylonjs/core/Cameras/arcRotateCamera.js";
import { Engine } from "@babylonjs/core/Engines/engine.js";
import { HemisphericLight } from "@babylonjs/core/Lights/hemisphericLight.js";
import { ImportMeshAsync, SceneLoader } from "@babylonjs/core/Loading/sceneLoader.js";
import { Color4 } from "@babylonjs/core/Maths/math.color.js";
import { Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { Scene } from "@babylonjs/core/scene.js";
import "@babylonjs/loaders/glTF/2.0/index.js";

const canvas = Object.assign(document.createElement("canvas"), { width: innerWidth, height: innerHeight });
document.body.style.margin = 0;
document.body.append(canvas);
const engine = new Engine(canvas, true, { preserveDrawingBuffer: true });
const scene = new Scene(engine);
scene.clearColor = new Color4(0.96, 0.96, 0.94, 1);
new HemisphericLight("light", new Vector3(0.5, 1, -0.5), scene).intensity = 1.2;

/** Returns the meshes that are drawn. */
const shown = () => scene.meshes.filter((mesh) => mesh.isEnabled() && mesh.getTotalVertices() > 0);
const triangles = () => shown().reduce((sum, mesh) => sum + mesh.getTotalIndices() / 3, 0);

/** Draws one frame with the whole model in view. */
async function draw() {
  const { min, max } = scene.getWorldExtends((mesh) => shown().includes(mesh));
  const size = max.subtract(min).length();
  const camera = scene.activeCamera ?? new ArcRotateCamera("camera", 1.9, 1.35, 1, Vector3.Zero(), scene);
  camera.setTarget(min.add(max).scale(0.5));
  [camera.radius, camera.minZ, camera.maxZ] = [1.4 * size, size / 100, 10 * size];
  await scene.whenReadyAsync();
  scene.render();
}

window.steps = []; // the number of triangles after each level
const complete = new Promise((resolve) => SceneLoader.OnPluginActivatedObservable.addOnce((loader) => {
  loader.onExtensionLoadedObservable.add((extension) => extension.onNodeLODsLoadedObservable?.add(() => window.steps.push(triangles())));
  loader.onCompleteObservable.add(resolve);
}));
await ImportMeshAsync(window.source, scene, { pluginExtension: ".glb", pluginOptions: { gltf: { useRangeRequests: true } } });
await draw();
await complete;
await draw();
window.result = { steps: window.steps, triangles: triangles(), meshes: shown().length, allMeshes: scene.meshes.filter((mesh) => mesh.getTotalVertices() > 0).length,
  hasTexture: scene.materials.map((material) => material.albedoTexture !== null) };
