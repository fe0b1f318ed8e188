// SPDX-License-Identifier: Apache-2.0
// Notes on the model. They are the page's hotspots (slot="hotspot-…" data-position data-normal, as
// in model-viewer) and the notes in the file that the attribute `annotations` names.
import { Vector3 } from "three";
import { readAnnotations, triple, type Annotation, type Triple } from "./annotations.ts";
import type { Bench, Tool } from "./bench.ts";
import { make } from "./dom.ts";
import type { Mark } from "./overlay.ts";

const kWatched = { childList: true, subtree: true, attributeFilter: ["slot", "data-position", "data-normal", "annotations"] };

export class Notes implements Tool {
  readonly content = make("ol", { class: "notes" });
  /** Called when a note is chosen, to open the sheet with `content`. */
  onChosen: () => void = () => undefined;
  /** Called when `content` has changed. `any` is false if `content` has nothing to read. */
  onFilled: (any: boolean) => void = () => undefined;
  #marks: Mark[] = [];
  #hotspots: Mark[] = [];
  #loading = "";
  #wanted: number | undefined; // the note of a link that was opened before the notes were loaded

  constructor(private readonly bench: Bench) {}

  attach(until: AbortSignal): void {
    const { host } = this.bench;
    const watch = new MutationObserver(() => this.#gather(until));
    watch.observe(host, kWatched);
    until.addEventListener("abort", () => {
      watch.disconnect();
      this.#loading = "";
      this.#show([]);
      this.#clear(this.#hotspots);
    });
    this.#gather(until);
  }

  reset(): void {
    this.#mark(undefined);
  }

  /** The number of the chosen note, from 1. */
  get setting(): string {
    const chosen = [...this.content.children].findIndex((entry) => entry.hasAttribute("aria-current"));
    return chosen < 0 ? "" : String(chosen + 1);
  }
  set setting(text: string) {
    if (!/^\d{1,4}$/.test(text)) return;
    this.#wanted = Number(text) - 1;
    this.#open();
  }

  /**
   * Shows the note that a link names, once the notes are loaded. Does not move the camera, because the link
   * also states the view.
   */
  #open(): void {
    if (this.#wanted === undefined || !this.#marks[this.#wanted]) return;
    this.#mark(this.#wanted);
    this.#wanted = undefined;
    this.onChosen();
  }

  #gather(until: AbortSignal): void {
    this.#pin();
    const file = this.bench.host.getAttribute("annotations") ?? "";
    if (file === this.#loading) return;
    this.#loading = file;
    void this.#load(file, until);
  }

  async #load(file: string, until: AbortSignal): Promise<void> {
    try {
      const answer = file ? await fetch(file, { signal: until }) : undefined;
      if (answer && !answer.ok) throw new Error(`status ${answer.status}`);
      const notes = answer ? readAnnotations(await answer.json()) : [];
      if (file === this.#loading) this.#show(notes);
    } catch (error) {
      if (until.aborted) return;
      this.#show([]);
      this.content.replaceChildren(make("li", {}, this.bench.texts.notesMissing));
      this.onFilled(true);
      console.warn(`annotations "${file}": ${(error as Error).message}`);
    }
  }

  #show(notes: Annotation[]): void {
    this.#clear(this.#marks);
    this.content.replaceChildren(...notes.map((note, i) => this.#entry(note, i)));
    this.#marks = notes.map((note, i) => this.#place(this.#button(note, i), note.position, note.normal));
    this.onFilled(notes.length > 0);
    this.#open();
    if (notes.length > 0) void this.bench.stage.draw();
  }

  #entry({ title, text }: Annotation, i: number): HTMLLIElement {
    const head = make("button", { type: "button", onclick: () => this.#choose(i) }, title);
    return make("li", {}, head, ...(text ? [make("p", {}, text)] : []));
  }

  #button({ title }: Annotation, i: number): HTMLElement {
    const label = this.bench.texts.noteMarker(i + 1, title);
    const button = make("button", { type: "button", "aria-label": label, onclick: () => this.#choose(i) }, make("span", {}, String(i + 1)));
    return make("div", { class: "marker" }, button);
  }

  #choose(i: number): void {
    const { point, normal } = this.#marks[i] as Mark;
    this.#mark(i);
    // If the note has no normal, moves the camera to the side of the model on which the point is.
    this.bench.orbit.flyTo(normal ?? point);
    this.onChosen();
    this.content.children[i]?.scrollIntoView({ block: "nearest" });
  }

  #mark(chosen: number | undefined): void {
    [...this.content.children].forEach((entry, i) => {
      if (i === chosen) entry.setAttribute("aria-current", "true");
      else entry.removeAttribute("aria-current");
    });
    this.#marks.forEach(({ element }, i) => element.classList.toggle("chosen", i === chosen));
  }

  /** Places the page's own hotspots. Each hotspot is an element of the page that is shown through a slot. */
  #pin(): void {
    this.#clear(this.#hotspots);
    for (const hotspot of this.bench.host.querySelectorAll<HTMLElement>(":scope > [slot^=hotspot-]")) {
      const position = triple(hotspot.dataset["position"]);
      if (!position) continue;
      const place = make("div", { class: "hotspot" }, make("slot", { name: hotspot.slot }));
      this.#hotspots.push(this.#place(place, position, triple(hotspot.dataset["normal"])));
    }
    void this.bench.stage.draw();
  }

  #place(element: HTMLElement, position: Triple, normal: Triple | undefined): Mark {
    const { mesh } = this.bench.stage, point = new Vector3(...position).sub(new Vector3(...mesh.info.centre)).applyMatrix4(mesh.matrixWorld);
    const mark: Mark = { element, point, ...(normal && { normal: new Vector3(...normal).applyQuaternion(mesh.quaternion) }) };
    this.bench.overlay.add(mark);
    return mark;
  }

  #clear(marks: Mark[]): void {
    for (const mark of marks.splice(0)) this.bench.overlay.remove(mark);
  }
}
