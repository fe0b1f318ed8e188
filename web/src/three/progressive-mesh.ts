// SPDX-License-Identifier: Apache-2.0
import {
  Box3, BufferGeometry, DoubleSide, Matrix4, Mesh, MeshStandardMaterial, Sphere, Vector3, type Object3DEventMap, type PerspectiveCamera,
} from "three";
import { RemoteModel } from "../core/client.ts";
import type { Assets } from "../core/messages.ts";
import type { Transport } from "../core/source.ts";
import type { ModelError, ModelInfo, Progress, Surface, Want } from "../core/types.ts";
import { SurfaceBuffers } from "./surface-buffers.ts";

/** Milliseconds of a frame that a surface on its way into the buffers may take. */
const kFrameBudget = 4;

export interface ProgressiveMeshEventMap extends Object3DEventMap {
  /** Another state of the surface is in the geometry: draw again. */
  refine: { surface: Pick<Surface, "triangles" | "vertices" | "bytes"> };
  progress: Progress;
  error: { error: ModelError };
}

/**
 * A mesh that sharpens in place. Its origin is the centre of the model's bounding box
 * (`info.centre` in model coordinates). Add it to a scene, call `refine`, draw on `refine` events;
 * `dispose` frees everything.
 */
export class ProgressiveMesh extends Mesh<BufferGeometry, MeshStandardMaterial, ProgressiveMeshEventMap> {
  readonly #model: RemoteModel;
  #buffers: SurfaceBuffers | undefined;
  #info: ModelInfo | undefined;
  #filling = 0;
  #shown: (() => void) | undefined;
  #base: { resolve(): void; reject(error: ModelError): void } | undefined;

  /** Resolves when the base mesh is in the geometry. */
  readonly ready: Promise<void>;

  constructor(url: string, assets: Assets, transport: Transport = "auto") {
    // Scans are open as often as not: who looks into one sees its inside.
    super(new BufferGeometry(), new MeshStandardMaterial({ color: 0xd8d3cb, roughness: 0.85, metalness: 0, side: DoubleSide }));
    this.ready = new Promise((resolve, reject) => (this.#base = { resolve, reject }));
    this.#model = new RemoteModel(url, transport, assets, {
      opened: (info) => this.#open(info),
      surface: (surface, shown) => this.#accept(surface, shown),
      progress: (progress) => this.dispatchEvent({ type: "progress", ...progress }),
      failed: (error) => this.#fail(error),
    });
  }

  /** The manifest; known once `ready`. */
  get info(): ModelInfo {
    if (!this.#info) throw new Error("wait for `ready` first");
    return this.#info;
  }

  /** True when `want` is reached and in the geometry, false when superseded. */
  refine(want: Want): Promise<boolean> {
    return this.#model.refine(want);
  }

  /**
   * Refines what `camera` sees in a viewport of `width` x `height` device pixels until no error there is above
   * `pixels`. What it does not see is left as it is: call this again when the camera has moved.
   */
  refineFor(camera: PerspectiveCamera, width: number, height: number, pixels = 1): Promise<boolean> {
    this.updateWorldMatrix(true, false);
    camera.updateWorldMatrix(true, false);
    const toModel = new Matrix4().makeTranslation(...this.info.centre).multiply(this.matrixWorld.clone().invert());
    const placed = toModel.multiply(camera.matrixWorld);
    return this.refine({ view: { camera: placed.toArray(), fov: camera.getEffectiveFOV(), width, height, pixels } });
  }

  dispose(): void {
    cancelAnimationFrame(this.#filling);
    this.#model.close();
    this.geometry.dispose();
    this.material.dispose();
    this.removeFromParent();
  }

  #open(info: ModelInfo): void {
    this.#info = info;
    const finest = info.levels[info.levels.length - 1];
    if (finest) this.#buffers = new SurfaceBuffers(this.geometry, finest);
    if (info.coloured) {
      this.material.vertexColors = true;
      this.material.color.set(0xffffff);
    }
  }

  #accept(surface: Surface, shown: () => void): void {
    this.#bound(surface);
    this.#shown = shown;
    const steps = this.#buffers?.replace(surface);
    if (steps) this.#fill(steps, surface);
  }

  /** Copies slices until the budget is spent, and goes on in the next frame. */
  #fill(steps: Generator<void>, surface: Surface): void {
    const end = performance.now() + kFrameBudget;
    while (!steps.next().done) {
      if (performance.now() < end) continue;
      this.#filling = requestAnimationFrame(() => this.#fill(steps, surface));
      return;
    }
    const { triangles, vertices, bytes } = surface;
    this.dispatchEvent({ type: "refine", surface: { triangles, vertices, bytes } });
    this.#base?.resolve();
    this.#base = undefined;
    this.#filling = requestAnimationFrame(() => this.#shown?.());
  }

  #fail(error: ModelError): void {
    this.#base?.reject(error);
    this.#base = undefined;
    this.dispatchEvent({ type: "error", error });
  }

  /** The base mesh's box bounds all levels, but for what refinement adds: some slack. */
  #bound(surface: Surface): void {
    if (!this.#base) return;
    const box = new Box3().setFromArray(surface.positions);
    const centre = box.getCenter(new Vector3());
    this.geometry.boundingBox = box;
    this.geometry.boundingSphere = new Sphere(centre, 0.55 * box.getSize(new Vector3()).length());
  }
}
