// SPDX-License-Identifier: Apache-2.0
import { Loader } from "three";
import { RemoteModel, assetsBeside } from "../core/client.ts";
import type { Assets } from "../core/messages.ts";
import { ProgressiveMesh } from "./progressive-mesh.ts";

/**
 * Has the interface of GLTFLoader: `load` and `loadAsync` give a ProgressiveMesh that shows its base mesh;
 * `mesh.refine({ triangles: 50_000 })` refines it. The URL is that of a .pmesh file, a model page or an
 * API model.
 */
export class ProgressiveMeshLoader extends Loader<ProgressiveMesh> {
  #assets: Assets = assetsBeside(import.meta.url);

  /** Sets the URLs of progressive-mesh.wasm and draco_decoder.{js,wasm}, if they are not in this module's folder. */
  setAssets(assets: Assets): this {
    this.#assets = assets;
    return this;
  }

  override load(
    url: string,
    onLoad: (mesh: ProgressiveMesh) => void,
    _onProgress?: (event: ProgressEvent) => void,
    onError?: (error: unknown) => void,
  ): void {
    const address = this.manager.resolveURL(this.path + url);
    const mesh = new ProgressiveMesh(new RemoteModel(address, "auto", this.#assets));
    this.manager.itemStart(url);
    mesh.ready
      .then(() => onLoad(mesh))
      .catch((error: unknown) => {
        mesh.dispose();
        this.manager.itemError(url);
        onError?.(error);
      })
      .finally(() => this.manager.itemEnd(url));
  }
}
