// SPDX-License-Identifier: Apache-2.0
// A canvas with a growing point cloud. The stage needs WebGL and is created when the first points
// arrive. Visitors who come after the scan see only the model, without a stage.
import { CloudStage } from "./cloud-stage.ts";

const media = (query: string) => matchMedia(`(${query})`);

export class CloudView {
  // Undefined before the first points arrive. Null if WebGL is not available or the view is
  // disposed of.
  #stage: CloudStage | null | undefined;
  readonly #size = new ResizeObserver(() => this.#fit());
  readonly #theme = media("prefers-color-scheme: dark");
  readonly #restyle = () => this.#stage?.restyle();

  /** Keeps the canvas at the size of `box`. */
  constructor(private readonly canvas: HTMLCanvasElement, private readonly box: HTMLElement) {
    this.#size.observe(box);
    this.#theme.addEventListener("change", this.#restyle);
  }

  add(points: Float32Array): void {
    this.#opened()?.add(points);
  }

  /** Removes all points. Called when the scan has started again from the beginning. */
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
      this.#stage = null; // without WebGL, the page shows only the texts
    }
    return this.#stage;
  }

  #fit(): void {
    const { clientWidth, clientHeight } = this.box;
    this.#stage?.resize(clientWidth, clientHeight);
  }
}
