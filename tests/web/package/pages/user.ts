// SPDX-License-Identifier: Apache-2.0
// A program that uses the package's types. It is type-checked, but not run.
import { PerspectiveCamera, Scene } from "three";
import { ModelError, ProgressiveMeshLoader, setBudget, type ProgressiveMesh } from "@vitrine/progressive-mesh";
import { ProgressiveMeshElement, type Assets } from "@vitrine/progressive-mesh/element";

setBudget({ triangles: 1e6, bytes: 1e8 });
const mesh: ProgressiveMesh = await new ProgressiveMeshLoader().loadAsync("bust.pmesh");
new Scene().add(mesh);
const reached: boolean = await mesh.refineFor(new PerspectiveCamera(), 640, 480);
mesh.addEventListener("error", ({ error }) => { const known: ModelError = error; throw known; });
// @ts-expect-error: a detail request has no such member
await mesh.refine({ sharpness: reached });

const viewer: ProgressiveMeshElement = document.createElement("progressive-mesh");
const assets: Partial<Assets> = { wasm: "/progressive-mesh.wasm" };
viewer.setAssets(assets);
viewer.addEventListener("refine", ({ detail }) => detail.triangles + 1);
viewer.addEventListener("click", (event: Event) => event.preventDefault());
document.querySelector("progressive-mesh")?.dismissPoster();
// @ts-expect-error: a token must be a string
viewer.token = 5;
