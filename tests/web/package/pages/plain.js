// SPDX-License-Identifier: Apache-2.0
// A page with one model in the element and one in a three.js scene of its own.
import { ProgressiveMeshLoader } from "@vitrine/progressive-mesh";
import { ProgressiveMeshElement } from "@vitrine/progressive-mesh/element";
import { Scene } from "three";

const viewer = document.createElement("progressive-mesh");
if (!(viewer instanceof ProgressiveMeshElement)) throw new Error("the element is not defined");
viewer.setAttribute("src", "/model.pmesh");
viewer.setAttribute("pixel-error", "0");
document.body.append(viewer);

new ProgressiveMeshLoader().load("/model.pmesh", (mesh) => {
  new Scene().add(mesh);
  document.body.dataset.loaded = String(mesh.info.levels.length);
});
