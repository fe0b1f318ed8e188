// SPDX-License-Identifier: Apache-2.0
// Entry point of the script that a page includes: <script type="module" src="/progressive-mesh.js"></script>
import { ProgressiveMeshElement } from "./progressive-mesh-element.ts";

export { ProgressiveMeshElement };
export type { ProgressiveMeshAttributes, ProgressiveMeshElementEventMap } from "./element-types.ts";
export type { ReactProgressiveMeshProps, VueProgressiveMeshProps } from "./frameworks.ts";
export type { Assets } from "../core/assets.ts";

declare global {
  interface HTMLElementTagNameMap {
    "progressive-mesh": ProgressiveMeshElement;
  }
}

// On a server that renders the page, there is no registry of elements.
if (globalThis.customElements && !customElements.get("progressive-mesh")) customElements.define("progressive-mesh", ProgressiveMeshElement);
