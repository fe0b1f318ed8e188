// SPDX-License-Identifier: Apache-2.0
// The page "#/scans/{id}" of a scan: its growing point cloud and its actions. When the scan is
// done, the model replaces the points.
import type { CloudView } from "../ui/cloud-view.ts";
import { h } from "../ui/dom.ts";
import { watchScan, type ScanSight } from "../ui/scan-watch.ts";
import { count, scanState, texts as gallery, timeLeft } from "../ui/texts/index.ts";
import { pause, type ConsolePage, type Visit } from "./desk.ts";
import { Alert, button, isConfirmed } from "./forms.ts";
import { sight } from "./model.ts";
import { Bar, modelBadge } from "./parts.ts";
import { texts } from "./texts/index.ts";
import type { Job, ModelRecord, Scan } from "./types.ts";

const words = texts.scan;

class ScanDesk implements ScanSight {
  readonly #canvas = h("canvas", { role: "img" });
  readonly #box = h("div", { class: "stage-box cloud" }, this.#canvas);
  readonly #bar = new Bar(gallery.scan.loading);
  readonly #state = h("strong", { role: "status" });
  readonly #facts = h("span", { class: "quiet" });
  readonly #actions = h("div", { class: "actions" });
  readonly #alert = new Alert();
  readonly #title = h("h1", { tabindex: -1 });
  readonly #badge = h("span");
  readonly #path: string;
  #cloud: CloudView | null = null;
  #points = 0;
  #choices = "";

  constructor(private readonly visit: Visit, private readonly id: string) {
    this.#path = `/scans/${id}`;
  }

  async open(): Promise<string> {
    const { desk, view, signal } = this.visit;
    const scan = await desk.api.get<Scan>(this.#path, signal);
    view.append(h("header", { class: "heading" }, this.#title, this.#badge), this.#box, this.#bar.element,
      h("p", { class: "row" }, this.#state, this.#facts), this.#actions, this.#alert.element);
    this.show(scan);
    void this.#watch();
    return scan.title;
  }

  /**
   * Follows the scan until it is done or cancelled. Also follows a failed scan, because an operator
   * may resume it.
   */
  async #watch(): Promise<void> {
    const { desk: { api }, signal } = this.visit, { CloudView } = await import("../ui/cloud-view.ts");
    if (signal.aborted) return;
    this.#cloud = new CloudView(this.#canvas, this.#box);
    signal.addEventListener("abort", () => this.#cloud?.dispose());
    const source = { scan: () => api.get<Scan>(this.#path, signal), points: (from: number) => api.points(this.id, from, signal) };
    await watchScan(source, this, (milliseconds) => pause(milliseconds, signal)).catch(() => undefined);
  }

  show(scan: Scan): void {
    const { title, step, steps, progress, eta, state } = scan;
    this.#title.textContent = title || gallery.untitled;
    this.#canvas.setAttribute("aria-label", gallery.scan.cloudOf(title));
    this.#say(scanState(scan));
    const left = state !== "paused" && eta !== null ? timeLeft(eta) : "", held = this.#points ? gallery.scan.points(count(this.#points)) : "";
    this.#facts.textContent = [gallery.scan.step(count(step), count(steps)), left, held].filter(Boolean).join(" · ");
    this.#bar.value = progress;
    if (state !== "scanning") this.#cloud?.settle();
    this.#offer(scan);
  }

  restart(): void {
    this.#cloud?.restart();
    this.#points = 0;
  }

  grow(points: Float32Array): void {
    this.#points += points.length / 3;
    this.#cloud?.add(points);
  }

  lost(): void {
    this.#say(gallery.scan.lost);
  }

  missing(): void {
    this.#say(words.missing);
  }

  #say(text: string): void {
    if (this.#state.textContent !== text) this.#state.textContent = text;
  }

  #offer(scan: Scan): void {
    // Replaces the buttons and the viewer only if the value that determines them has changed.
    const choices = scan.model ?? scan.state;
    if (choices === this.#choices) return;
    this.#choices = choices;
    if (scan.model) return void this.#modelled(scan.model).catch((error) => this.#alert.show(error));
    const { state } = scan, { api } = this.visit.desk, isOpen = state === "waiting" || state === "scanning" || state === "paused" || state === "meshing" || state === "building";
    const cancel = async () => {
      if (await isConfirmed(words.cancelQuestion, words.cancelExplanation, words.cancel)) await api.send<Job>("DELETE", `/jobs/${scan.job}`);
    };
    const order = (what: string) => () => api.send<Scan>("POST", `${this.#path}/${what}`, {});
    this.#actions.replaceChildren(
      ...(state === "scanning" ? [button(words.pause, this.#alert, order("pause"))] : []),
      ...(state === "paused" || state === "failed" ? [button(words.resume, this.#alert, order("resume"), "primary")] : []),
      ...(isOpen ? [button(words.cancel, this.#alert, cancel)] : []));
  }

  /** Shows the model instead of the points. The model may be a draft. */
  async #modelled(id: string): Promise<void> {
    const { desk } = this.visit, model = await desk.api.get<ModelRecord>(`/models/${id}`, this.visit.signal);
    const publish = async () => {
      await desk.api.send<ModelRecord>("POST", `/models/${id}/publish`);
      desk.say(texts.model.isPublic);
      await this.#modelled(id);
    };
    this.#bar.element.hidden = true;
    this.#cloud?.dispose();
    this.#cloud = null;
    this.#badge.replaceChildren(modelBadge(model));
    this.#box.classList.remove("cloud");
    this.#box.replaceChildren(sight(this.visit, model));
    this.#actions.replaceChildren(
      ...(model.state === "draft" ? [button(texts.model.publish, this.#alert, publish, "primary")] : [h("a", { class: "button primary", href: model.links.page }, words.inGallery)]),
      h("a", { class: "button", href: `#/models/${id}` }, words.details));
  }
}

export const scanPage: ConsolePage = (visit) => new ScanDesk(visit, visit.words[0] as string).open();
