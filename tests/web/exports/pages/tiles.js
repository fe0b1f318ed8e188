// SPDX-License-Identifier: Apache-2.0
// Shows the tileset `source` with 3DTilesRendererJS in a scene in which z points up. window.look() moves the camera.
import { TilesRenderer } from "3d-tiles-renderer";
import { Box3, DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Sphere, Vector3, WebGLRenderer } from "three";

const renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(innerWidth, innerHeight);
renderer.setClearColor(0xf6f4ef);
document.body.style.margin = 0;
document.body.append(renderer.domElement);

const scene = new Scene(), camera = new PerspectiveCamera(40, innerWidth / innerHeight), light = new DirectionalLight(0xffffff, 2);
camera.up.set(0, 0, 1);
light.position.set(1, -2, 2);
const tiles = new TilesRenderer(window.source);
tiles.errorTarget = 1;
tiles.setCamera(camera);
tiles.setResolutionFromRenderer(camera, renderer);
scene.add(new HemisphereLight(0xffffff, 0x888888, 1.5), light, tiles.group);

window.failures = [];
tiles.addEventListener("load-error", ({ error }) => window.failures.push(String(error)));

/** Waits until the tileset has loaded all that the camera needs, and draws it. */
async function settle() {
  const isBusy = () => tiles.root === null || tiles.stats.downloading + tiles.stats.parsing + tiles.stats.queued > 0;
  for (let quiet = 0; quiet < 3; quiet = isBusy() ? 0 : quiet + 1) {
    await new Promise(requestAnimationFrame);
    tiles.update();
  }
  renderer.render(scene, camera);
}

function described() {
  let triangles = 0, meshes = 0;
  tiles.group.traverse((node) => {
    if (!node.isMesh) return;
    ++meshes;
    triangles += node.geometry.index.count / 3;
  });
  const box = new Box3().setFromObject(tiles.group, true), volume = new Box3();
  tiles.getBoundingBox(volume);
  return { triangles, meshes, low: box.min.toArray(), high: box.max.toArray(), isInVolume: volume.containsBox(box), failures: window.failures };
}

/**
 * Looks at the model from the front, from a distance of `times` its radius. Returns the numbers of
 * triangles and meshes shown, and their bounds.
 */
window.look = async (times) => {
  const sphere = new Sphere();
  while (!tiles.getBoundingSphere(sphere)) {
    await new Promise(requestAnimationFrame);
    tiles.update();
  }
  const distance = times * sphere.radius;
  camera.position.copy(sphere.center).add(new Vector3(0.3, -1, 0.2).setLength(distance));
  [camera.near, camera.far] = [distance / 100, distance + 2 * sphere.radius];
  camera.updateProjectionMatrix();
  camera.lookAt(sphere.center);
  camera.updateMatrixWorld();
  await settle();
  return described();
};
window.isReady = true;
