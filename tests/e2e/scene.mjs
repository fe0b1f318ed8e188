// SPDX-License-Identifier: Apache-2.0
// A page with its own three.js scene that uses the published ProgressiveMeshLoader.
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import { ViewerPage } from "./browser.mjs";

const web = new URL("../../web/", import.meta.url);
const { build } = createRequire(new URL("package.json", web))("esbuild");

/** Runs in the page: draws models in front of a magenta background, which shows through cracks. */
const kScene = `
import * as THREE from "three";
import { GLTFExporter } from "three/examples/jsm/exporters/GLTFExporter.js";
import { OBJExporter } from "three/examples/jsm/exporters/OBJExporter.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { OBJLoader } from "three/examples/jsm/loaders/OBJLoader.js";
import * as vitrine from "./dist/progressive-mesh-loader.js";
const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
renderer.setSize(innerWidth, innerHeight);
document.body.replaceChildren(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0xff00ff);
const sun = new THREE.DirectionalLight(0xffffff, 3);
sun.position.set(-1, 1, 1);
scene.add(sun, new THREE.AmbientLight(0xffffff, 0.5));
const camera = new THREE.PerspectiveCamera(35, innerWidth / innerHeight, 0.001, 100);
window.scene = { THREE, GLTFExporter, GLTFLoader, OBJExporter, OBJLoader, vitrine, renderer, scene, camera, meshes: [],
  draw: () => renderer.render(scene, camera),
  frame: () => new Promise(requestAnimationFrame),
  async load(url) {
    const mesh = await new vitrine.ProgressiveMeshLoader().loadAsync(url);
    scene.add(mesh);
    this.meshes.push(mesh);
    this.draw();
    return mesh;
  },
  look(mesh, theta, distance) {
    const { radius } = mesh.geometry.boundingSphere;
    camera.position.setFromSphericalCoords(distance * radius, 1.3, theta);
    camera.near = radius / 100, camera.far = 100 * radius;
    camera.lookAt(0, 0, 0);
    camera.updateProjectionMatrix();
  },
  pixels() {
    const gl = renderer.getContext(), { width, height } = renderer.domElement;
    const data = new Uint8Array(4 * width * height);
    this.draw();
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
    return { data, width, height };
  },
};`;

/** Bundles the page's script, adds the page to `host` and opens it. */
export async function openScene(browser, host, options) {
  const { outputFiles } = await build({ stdin: { contents: kScene, resolveDir: fileURLToPath(web) }, bundle: true, format: "esm", write: false });
  host.add("scene.js", outputFiles[0].contents);
  const url = host.add("scene.html", `<!doctype html><link rel="icon" href="data:,"><style>body { margin: 0 }</style><body><script type="module" src="/scene.js"></script>`);
  const viewer = await ViewerPage.open(browser, url, { width: 320, height: 320, ...options });
  await viewer.page.waitForFunction(() => window.scene);
  return viewer.page;
}
