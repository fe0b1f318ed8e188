// SPDX-License-Identifier: Apache-2.0
// The page "/scans/{id}". It shows the growing point cloud of a scan. When the scan has a model,
// the page shows the model instead.
import { scan, scanPoints, type ScanRecord } from "../ui/api.ts";
import { CloudView } from "../ui/cloud-view.ts";
import { watchScan, type ScanSight } from "../ui/scan-watch.ts";
import { count, language, scanState, texts, timeLeft } from "../ui/texts/index.ts";

const id = decodeURIComponent(location.pathname.split("/").filter(Boolean).pop() ?? "");
const find = <T extends HTMLElement>(selector: string) => document.querySelector(selector) as T;

class LiveScan implements ScanSight {
  readonly #main = find("main");
  readonly #growth = find("#growth");
  readonly #viewer = find("progressive-mesh");
  readonly #canvas = find<HTMLCanvasElement>("canvas");
  readonly #cloud = new CloudView(this.#canvas, find("#view"));
  #count = 0;

  constructor() {
    document.documentElement.lang = language;
    find("#progress").setAttribute("aria-label", texts.scan.loading);
    find("#back").textContent = texts.collection;
    this.#viewer.addEventListener("first-paint", () => void this.#unveil());
    this.#viewer.addEventListener("error", () => this.#say(texts.notOnDisplay));
  }

  show(scan: ScanRecord): void {
    this.#name(scan.title || texts.untitled);
    this.#tell(scan);
    if (scan.state !== "scanning") this.#cloud.settle();
    if (scan.model !== null) this.#viewer.setAttribute("src", `/api/v1/models/${encodeURIComponent(scan.model)}`);
  }

  restart(): void {
    this.#cloud.restart();
    this.#hold(0);
  }

  grow(points: Float32Array): void {
    this.#cloud.add(points);
    this.#hold(this.#count + points.length / 3);
  }

  lost(): void {
    this.#say(texts.scan.lost);
  }

  missing(): void {
    this.#name(texts.scan.missing);
    this.#say("");
  }

  #hold(points: number): void {
    this.#count = points;
    find("#points").textContent = texts.scan.points(count(points));
  }

  #name(title: string): void {
    document.title = find("#title").textContent = title;
    this.#viewer.setAttribute("alt", title);
    this.#canvas.setAttribute("aria-label", texts.scan.cloudOf(title));
  }

  #tell(scan: ScanRecord): void {
    const { state, step, steps, progress, eta } = scan;
    const isUnderWay = state !== "done" && state !== "failed" && state !== "cancelled";
    this.#say(scanState(scan));
    find("#step").textContent = steps > 0 ? texts.scan.step(count(step), count(steps)) : "";
    find("#left").textContent = isUnderWay && state !== "paused" && eta !== null ? timeLeft(eta) : "";
    find("#progress").setAttribute("aria-valuenow", String(Math.round(100 * progress)));
    (find("#progress").firstElementChild as HTMLElement).style.transform = `scaleX(${progress})`;
  }

  /** Updates the text only if it has changed, because screen readers announce every update. */
  #say(text: string): void {
    if (find("#state").textContent !== text) find("#state").textContent = text;
    if (text === texts.scan.lost || text === "") find("#left").textContent = "";
  }

  /** Shows the model instead of the points. Called when the model's base mesh is on the screen. */
  async #unveil(): Promise<void> {
    this.#main.classList.add("modelled");
    await Promise.allSettled(this.#growth.getAnimations().map(({ finished }) => finished));
    this.#growth.hidden = true;
    this.#cloud.dispose();
  }
}

await watchScan({ scan: () => scan(id), points: (from) => scanPoints(id, from) }, new LiveScan());
