// SPDX-License-Identifier: Apache-2.0
// A page that tells the viewer where its files are, because they are neither beside the bundle nor
// moved by the bundler.
import { ProgressiveMeshLoader } from "@vitrine/progressive-mesh";
import "@vitrine/progressive-mesh/element";

const at = (name) => new URL(`/moved/${name}`, location.href).href;
const assets = { worker: at("progressive-mesh-worker.js"), wasm: at("progressive-mesh.wasm") };
document.body.innerHTML = `<progressive-mesh src="/model.pmesh" pixel-error="0"></progressive-mesh>`;
document.querySelector("progressive-mesh").setAssets(assets);
new ProgressiveMeshLoader().setAssets(assets).load("/model.pmesh", (mesh) => {
  document.body.dataset.loaded = String(mesh.info.levels.length);
});
