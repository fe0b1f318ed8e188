// SPDX-License-Identifier: Apache-2.0
// A page of Babylon.js that loads a GLB and draws it.
import { Engine } from "@babylonjs/core/Engines/engine.js";
import { LoadAssetContainerAsync } from "@babylonjs/core/Loading/sceneLoader.js";
import { Color4 } from "@babylonjs/core/Maths/math.color.js";
import { DracoDecoder } from "@babylonjs/core/Meshes/Compression/dracoDecoder.js";
import { MeshoptCompression } from "@babylonjs/core/Meshes/Compression/meshoptCompression.js";
import { Scene } from "@babylonjs/core/scene.js";
import "@babylonjs/core/Helpers/sceneHelpers.js";
import "@babylonjs/loaders/glTF/2.0/index.js";

// Sets the URLs of the decoders. By default, Babylon.js would load them from its own web site.
DracoDecoder.DefaultConfiguration = {
  wasmUrl: "/draco/draco_wasm_wrapper.js", wasmBinaryUrl: "/draco/draco_decoder.wasm", fallbackUrl: "/draco/draco_decoder.js",
};
MeshoptCompression.Configuration.decoder.url = "/meshopt/meshopt_decoder.js";

const kPixels = 400;
const canvas = Object.assign(document.createElement("canvas"), { width: kPixels, height: kPixels });
document.body.append(canvas);
const engine = new Engine(canvas, true, { preserveDrawingBuffer: true });

/**
 * Returns how many pixels of the picture are not black, how many are red, and how many are blue.
 */
async function covered() {
  const pixels = await engine.readPixels(0, 0, kPixels, kPixels);
  const found = { covered: 0, red: 0, blue: 0 };
  for (let i = 0; i < pixels.length; i += 4) {
    const [r, g, b] = pixels.subarray(i, i + 3);
    found.covered += r + g + b > 0;
    found.red += r > 2 * b;
    found.blue += b > 2 * r;
  }
  return found;
}

window.client = {
  async glb(url) {
    const scene = new Scene(engine);
    scene.clearColor = new Color4(0, 0, 0, 1);
    const container = await LoadAssetContainerAsync(url, scene, { pluginExtension: ".glb" });
    container.addAllToScene();
    scene.createDefaultCameraOrLight(true, true, false);
    await scene.whenReadyAsync();
    scene.render();
    const { min, max } = scene.getWorldExtends(), meshes = scene.meshes.filter((mesh) => mesh.getTotalVertices() > 0);
    const found = {
      meshes: meshes.length, triangles: meshes.reduce((sum, mesh) => sum + mesh.getTotalIndices() / 3, 0), size: max.subtract(min).asArray(),
      normals: meshes.every((mesh) => mesh.isVerticesDataPresent("normal")), ...(await covered()),
    };
    scene.dispose();
    return found;
  },
};
