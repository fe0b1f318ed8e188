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

// A server that renders the page has no registry of custom elements.
if (globalThis.customElements && !customElements.get("progressive-mesh")) customElements.define("progressive-mesh", ProgressiveMeshElement);
