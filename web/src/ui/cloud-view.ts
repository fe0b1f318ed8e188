// SPDX-License-Identifier: Apache-2.0
// A canvas with a growing point cloud. The stage, which needs WebGL, is created when the first points arrive: visitors
// who come after the scan see only the model.
import { CloudStage } from "./cloud-stage.ts";

const media = (query: string) => matchMedia(`(${query})`);

export class CloudView {
  #stage: CloudStage | null | undefined; // undefined before the first points; null if disposed of or without WebGL
  readonly #size = new ResizeObserver(() => this.#fit());
  readonly #theme = media("prefers-color-scheme: dark");
  readonly #restyle = () => this.#stage?.restyle();

  /** The canvas always gets the size of `box`. */
  constructor(private readonly canvas: HTMLCanvasElement, private readonly box: HTMLElement) {
    this.#size.observe(box);
    this.#theme.addEventListener("change", this.#restyle);
  }

  add(points: Float32Array): void {
    this.#opened()?.add(points);
  }

  /** Removes all points, because the scan measures again. */
  restart(): void {
    this.#stage?.restart();
  }

  /** Called when no more points are expected for now. Stops highlighting the newest points. */
  settle(): void {
    this.#stage?.settle();
  }

  dispose(): void {
    this.#size.disconnect();
    this.#theme.removeEventListener("change", this.#restyle);
    this.#stage?.dispose();
    this.#stage = null;
  }

  #opened(): CloudStage | null {
    if (this.#stage !== undefined) return this.#stage;
    try {
      this.#stage = new CloudStage(this.canvas, media("prefers-reduced-motion: reduce").matches);
      this.#fit();
    } catch {
      this.#stage = null; // no WebGL: the page shows only the texts
    }
    return this.#stage;
  }

  #fit(): void {
    const { clientWidth, clientHeight } = this.box;
    this.#stage?.resize(clientWidth, clientHeight);
  }
}
