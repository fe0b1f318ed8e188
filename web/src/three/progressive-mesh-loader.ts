// SPDX-License-Identifier: Apache-2.0
import { Loader } from "three";
import { assetsWith, type Assets } from "../core/assets.ts";
import { RemoteModel } from "../core/client.ts";
import { ProgressiveMesh } from "./progressive-mesh.ts";

/**
 * A loader with the interface of GLTFLoader. `load` and `loadAsync` give a ProgressiveMesh that
 * shows its base mesh. `mesh.refine({ triangles: 50_000 })` refines the mesh. The URL is that of a
 * .pmesh file, a model page or a model in the API.
 */
export class ProgressiveMeshLoader extends Loader<ProgressiveMesh> {
  #assets: Partial<Assets> = {};

  /**
   * Sets the URLs of viewer files that are neither in this module's folder nor where a bundler has put them. All models of a
   * page share one worker and its decoders, so the URLs set for the first model apply to all.
   */
  setAssets(assets: Partial<Assets>): this {
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
    const mesh = new ProgressiveMesh(new RemoteModel(address, "auto", assetsWith(this.#assets)));
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
