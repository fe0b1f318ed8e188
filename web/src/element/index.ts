// SPDX-License-Identifier: Apache-2.0
// Entry point of the script that a page includes: <script type="module" src="/progressive-mesh.js"></script>
import { ProgressiveMeshElement } from "./progressive-mesh-element.ts";

if (!customElements.get("progressive-mesh")) customElements.define("progressive-mesh", ProgressiveMeshElement);
