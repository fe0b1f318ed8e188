// SPDX-License-Identifier: Apache-2.0
// A canvas in which points grow. It has a stage from the first points on: who comes when all is
// over needs none.
import { CloudStage } from "./cloud-stage.ts";

const media = (query: string) => matchMedia(`(${query})`);

export class CloudView {
  #stage: CloudStage | null | undefined; // null: there is none any more, or no WebGL
  readonly #size = new ResizeObserver(() => this.#fit());
  readonly #theme = media("prefers-color-scheme: dark");
  readonly #restyle = () => this.#stage?.restyle();

  /** The canvas fills `box`. */
  constructor(private readonly canvas: HTMLCanvasElement, private readonly box: HTMLElement) {
    this.#size.observe(box);
    this.#theme.addEventListener("change", this.#restyle);
  }

  add(points: Float32Array): void {
    this.#opened()?.add(points);
  }

  /** The points so far are no longer the scan's. */
  restart(): void {
    this.#stage?.restart();
  }

  /** Nothing more comes for now. */
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
      this.#stage = null; // no WebGL: the words remain
    }
    return this.#stage;
  }

  #fit(): void {
    const { clientWidth, clientHeight } = this.box;
    this.#stage?.resize(clientWidth, clientHeight);
  }
}
