// SPDX-License-Identifier: Apache-2.0
// The page "/scans/{id}": an object as it is measured. Its points grow where the model will stand.
import { scanState, texts, timeLeft } from "../texts.ts";
import { scan, scanPoints, type ScanRecord } from "./api.ts";
import { CloudStage } from "./cloud-stage.ts";
import { watchScan, type ScanSight } from "./scan-watch.ts";

const id = decodeURIComponent(location.pathname.split("/").filter(Boolean).pop() ?? "");
const find = <T extends HTMLElement>(selector: string) => document.querySelector(selector) as T;
const media = (query: string) => matchMedia(`(${query})`);

class ScanPage implements ScanSight {
  readonly #main = find("main");
  readonly #growth = find("#growth");
  readonly #viewer = find("progressive-mesh");
  readonly #canvas = find<HTMLCanvasElement>("canvas");
  #stage: CloudStage | null | undefined; // null: there is none any more
  #count = 0;

  constructor() {
    find("#progress").setAttribute("aria-label", texts.loading);
    find("#back").textContent = texts.back;
    this.#viewer.addEventListener("first-paint", () => void this.#unveil());
    this.#viewer.addEventListener("error", () => this.#say(texts.modelFailed));
    new ResizeObserver(() => this.#fit()).observe(find("#view"));
    media("prefers-color-scheme: dark").addEventListener("change", () => this.#stage?.restyle());
  }

  show(scan: ScanRecord): void {
    this.#name(scan.title || texts.untitled);
    this.#tell(scan);
    if (scan.state !== "scanning") this.#stage?.settle();
    if (scan.model !== null) this.#viewer.setAttribute("src", `/api/v1/models/${encodeURIComponent(scan.model)}`);
  }

  restart(): void {
    this.#stage?.restart();
    this.#hold(0);
  }

  grow(points: Float32Array): void {
    const stage = this.#opened();
    stage?.add(points);
    this.#hold(this.#count + points.length / 3);
  }

  lost(): void {
    this.#say(texts.scanLost);
  }

  missing(): void {
    this.#name(texts.scanMissing);
    this.#say("");
  }

  #hold(count: number): void {
    this.#count = count;
    find("#points").textContent = texts.points(count);
  }

  #name(title: string): void {
    document.title = find("#title").textContent = title;
    this.#viewer.setAttribute("alt", title);
    this.#canvas.setAttribute("aria-label", texts.cloudOf(title));
  }

  #tell(scan: ScanRecord): void {
    const { state, step, steps, progress, eta } = scan;
    const underWay = state !== "done" && state !== "failed" && state !== "cancelled";
    this.#say(scanState(scan));
    find("#step").textContent = steps > 0 ? texts.step(step, steps) : "";
    find("#left").textContent = underWay && state !== "paused" && eta !== null ? timeLeft(eta) : "";
    find("#progress").setAttribute("aria-valuenow", String(Math.round(100 * progress)));
    (find("#progress").firstElementChild as HTMLElement).style.transform = `scaleX(${progress})`;
  }

  /** A screen reader says what is new, and only that. */
  #say(text: string): void {
    if (find("#state").textContent !== text) find("#state").textContent = text;
    if (text === texts.scanLost || text === "") find("#left").textContent = "";
  }

  /** At the first points: who comes when all is over needs no stage. */
  #opened(): CloudStage | null {
    if (this.#stage !== undefined) return this.#stage;
    try {
      this.#stage = new CloudStage(this.#canvas, media("prefers-reduced-motion: reduce").matches);
      this.#fit();
    } catch {
      this.#stage = null; // no WebGL: the words remain
    }
    return this.#stage;
  }

  #fit(): void {
    const { clientWidth, clientHeight } = find("#view");
    this.#stage?.resize(clientWidth, clientHeight);
  }

  /** The base mesh is on the screen: the points go. */
  async #unveil(): Promise<void> {
    this.#main.classList.add("modelled");
    await Promise.allSettled(this.#growth.getAnimations().map(({ finished }) => finished));
    this.#growth.hidden = true;
    this.#stage?.dispose();
    this.#stage = null;
  }
}

await watchScan({ scan: () => scan(id), points: (from) => scanPoints(id, from) }, new ScanPage());
