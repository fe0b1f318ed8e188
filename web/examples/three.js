// SPDX-License-Identifier: Apache-2.0
import { DirectionalLight, PerspectiveCamera, Scene, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { ProgressiveMeshLoader, setBudget } from "@vitrine/progressive-mesh";

const renderer = new WebGLRenderer({ antialias: true });
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);
const camera = new PerspectiveCamera(35, innerWidth / innerHeight, 0.01, 1000);
const scene = new Scene().add(camera.add(new DirectionalLight()));
const controls = new OrbitControls(camera, renderer.domElement);

setBudget({ triangles: 1_000_000, bytes: 50e6 }); // limits for all models together
const loader = new ProgressiveMeshLoader();
const meshes = await Promise.all(["bust.pmesh", "skull.pmesh"].map((url) => loader.loadAsync(url)));
meshes.forEach((mesh, i) => {
  mesh.scale.setScalar(1 / mesh.geometry.boundingSphere.radius);
  mesh.position.x = 2 * i - 1;
});
scene.add(...meshes);
camera.position.z = 7;

/** Refines the visible parts of each model until their error is at most one pixel. */
function sharpen() {
  const { width, height } = renderer.domElement;
  for (const mesh of meshes) mesh.refineFor(camera, width, height).catch((error) => console.warn(error.message));
}
let looking;
controls.addEventListener("change", () => {
  clearTimeout(looking);
  looking = setTimeout(sharpen, 100);
});
sharpen();
renderer.setAnimationLoop(() => {
  controls.update();
  renderer.render(scene, camera);
});
