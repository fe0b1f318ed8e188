// SPDX-License-Identifier: Apache-2.0
// Shows notes on the model and plays tours through them. This file is loaded when a model or a page has notes, and shares no
// code with the viewer's other files. The notes are those of the daemon, the page's hotspots (slot="hotspot-…" data-position
// data-normal, as in model-viewer), and those in the file that the attribute `annotations` names.
import { Vector3 } from "three";
import type { Bench, Tool } from "../tools/bench.ts";
import type { make as makeElement } from "../tools/dom.ts";
import type { apiOf as addressOf } from "../tools/links.ts";
import type { Mark } from "../tools/overlay.ts";
import type { Light } from "../tools/light.ts";
import type { pick as pickPoint } from "../tools/pick.ts";
import type { anglesOf as angles, OrbitView } from "../tools/view.ts";
import { inLanguage, languageIn, lightOf, readAnnotations, triple, type Annotation, type NoteView, type StoredNote, type StoredTour, type Triple } from "./annotations.ts";
import { describe } from "./describe.ts";
import style from "./notes.css?text";
import { TourPlayer } from "./tour-player.ts";

/** Functions and tools of the toolbox. */
export interface NoteKit {
  make: typeof makeElement;
  apiOf: typeof addressOf;
  anglesOf: typeof angles;
  pick: typeof pickPoint;
  style(css: string): void;
  /** The container of the notes, in a sheet. */
  content: HTMLElement;
  light: Tool & Pick<Light, "presented">;
  section: Tool;
  onChosen(): void;
  onFilled(any: boolean): void;
  /** Closes the sheet, because a tour begins. */
  onTour(): void;
}

/** The daemon's notes and tours of a model. */
export interface NoteDocuments {
  notes: StoredNote[];
  tours: StoredTour[];
}

const kTillPreview = 200; // milliseconds from the last change of the notes until they are shown

export class NoteReader {
  readonly #list: HTMLOListElement;
  readonly #tours: HTMLElement;
  readonly #player: TourPlayer;
  #notes: Annotation[] = [];
  #marks: Mark[] = [];
  readonly #places = new Map<Mark, Pick<Annotation, "position" | "normal">>(); // of notes and hotspots, in model coordinates
  #later: ReturnType<typeof setTimeout> | undefined; // timer that shows a preview
  #hotspots: Mark[] = [];
  #source = ""; // where the notes come from
  #wanted = ""; // the note of a link that was opened before the notes were loaded

  constructor(private readonly bench: Bench, private readonly kit: NoteKit) {
    kit.style(style);
    this.#list = kit.make("ol", { class: "notes" });
    this.#tours = kit.make("div", { class: "tours" });
    kit.content.replaceChildren(this.#tours, this.#list);
    this.#player = new TourPlayer(bench, kit, (note, isCut) => this.#show(note, isCut));
  }

  /** Shows the notes that the page and the model have now. */
  gather(until: AbortSignal): void {
    this.#pin();
    const { host, stage } = this.bench, file = host.getAttribute("annotations") ?? "";
    const api = stage.mesh.info.presentation?.notes ? this.#api : undefined;
    const source = `${file} ${api ?? ""}`;
    if (source === this.#source) return;
    this.#source = source;
    void this.#load(file, api, until, source);
  }

  /** Removes all notes from the stage. Call this before the stage is disposed of. */
  leave(): void {
    this.#source = "";
    clearTimeout(this.#later);
    this.#player.end();
    this.#clear(this.#marks);
    this.#clear(this.#hotspots);
    this.#list.replaceChildren();
    this.#tours.replaceChildren();
  }

  reset(): void {
    this.#player.end();
    this.#mark(undefined);
  }

  /** The number of the chosen note, from 1. */
  get setting(): string {
    const chosen = [...this.#list.children].findIndex((entry) => entry.hasAttribute("aria-current"));
    return chosen < 0 ? "" : String(chosen + 1);
  }
  set setting(text: string) {
    if (!/^\d{1,4}$/.test(text)) return;
    this.#wanted = text;
    this.#open();
  }

  /** Replaces the daemon's notes by others, which may not be saved yet. Shows them kTillPreview ms after the last call. */
  preview(documents: NoteDocuments): void {
    this.#source += " preview"; // ignores a response that arrives later
    clearTimeout(this.#later);
    this.#later = setTimeout(() => this.#replace(documents), kTillPreview);
  }

  /** Moves the marks after the presentation of the model has changed. */
  follow(): void {
    for (const [mark, { position, normal }] of this.#places) Object.assign(mark, this.#spot(position, normal));
  }

  /** Shows other notes and tours instead of the present ones. The chosen note stays chosen. */
  #replace(documents: NoteDocuments): void {
    const chosen = this.#notes[Number(this.setting) - 1]?.id;
    this.#fill(documents.notes.map((note) => inLanguage(note, this.#language, this.#api)), documents);
    if (chosen !== undefined) this.#mark(this.#notes.findIndex(({ id }) => id === chosen));
  }

  /** Returns the point and the normal of the surface at a point of the window, in model coordinates. */
  pick(clientX: number, clientY: number): Pick<StoredNote, "position" | "normal"> | undefined {
    const { stage, view } = this.bench, { left, top } = view.getBoundingClientRect(), x = clientX - left, y = clientY - top;
    const [at, right, below] = ([[0, 0], [3, 0], [0, 3]] as const).map(([dx, dy]) => this.kit.pick(stage, x + dx, y + dy));
    if (!at) return undefined;
    const eye = stage.parts.camera.position.clone().sub(at);
    // Beside an edge of the model, the direction to the eye stands for the normal.
    const across = right && below ? below.sub(at).cross(right.sub(at)) : eye.clone();
    const normal = across.lengthSq() > 0 && across.normalize().dot(eye.normalize()) > 0.1 ? across : eye;
    return { position: this.#inModel(at), normal: rounded(normal.applyQuaternion(stage.mesh.quaternion.clone().invert())) };
  }

  /** The present view, light and section. */
  get moment(): Required<Pick<StoredNote, "view" | "light" | "section">> {
    const { stage } = this.bench, { camera, controls: { target } } = stage.parts;
    const offset = camera.position.clone().sub(target), distance = offset.length();
    const zoom = Math.min(100, Math.max(0.1, stage.fittingDistance(target, offset.clone().normalize()) / distance));
    const direction = rounded(offset.divideScalar(distance).applyQuaternion(stage.mesh.quaternion.clone().invert()));
    const view: NoteView = { direction, zoom: Number(zoom.toPrecision(6)), ...(target.lengthSq() > 0 && { target: this.#inModel(target) }) };
    return { view, light: lightOf(this.kit.light.presented), section: this.kit.section.setting ?? "" };
  }

  /** The URL of the model in the daemon's API. Undefined for a file. */
  get #api(): string | undefined {
    return this.kit.apiOf(new URL(this.bench.host.getAttribute("src") ?? "", document.baseURI).href);
  }

  get #language(): string {
    return this.bench.host.closest<HTMLElement>("[lang]")?.lang ?? "";
  }

  async #load(file: string, api: string | undefined, until: AbortSignal, source: string): Promise<void> {
    const { token } = this.bench.host, headers = token ? { Authorization: `Bearer ${token}` } : {};
    const read = async (url: string, init: RequestInit = {}): Promise<unknown> => {
      const answer = await fetch(url, { ...init, signal: until });
      if (!answer.ok) throw new Error(`${url}: status ${answer.status}`);
      return answer.json();
    };
    const ofDaemon = async <Part extends keyof NoteDocuments>(part: Part): Promise<NoteDocuments[Part]> =>
      api ? ((await read(`${api}/${part}`, { headers })) as NoteDocuments)[part] : [];
    const inFile = async () => (file ? readAnnotations(await read(file)) : []);
    const [own, notes, tours] = await Promise.allSettled([inFile(), ofDaemon("notes"), ofDaemon("tours")]);
    if (until.aborted || source !== this.#source) return;
    const documents = { notes: valueOf(notes, []), tours: valueOf(tours, []) };
    this.#fill([...documents.notes.map((note) => inLanguage(note, this.#language, api)), ...valueOf(own, [])], documents);
    for (const one of [own, notes, tours]) if (one.status === "rejected") this.#miss(source, one.reason as Error);
  }

  /** Tells the visitor that one source of notes cannot be loaded. */
  #miss(source: string, error: Error): void {
    if (!this.#list.querySelector(".missing")) this.#list.append(this.kit.make("li", { class: "missing" }, this.bench.texts.notesMissing));
    this.kit.onFilled(true);
    console.warn(`notes "${source.trim()}": ${error.message}`);
  }

  #fill(notes: Annotation[], { tours }: NoteDocuments): void {
    this.#player.end();
    this.#clear(this.#marks);
    this.#notes = notes;
    this.#list.replaceChildren(...notes.map((note, i) => this.#entry(note, i)));
    this.#marks = notes.map((note, i) => this.#place(this.#button(note, i), note.position, note.normal));
    this.#tours.replaceChildren(...tours.map((tour) => this.#tour(tour)).filter((button) => button !== undefined));
    this.kit.onFilled(notes.length > 0);
    this.#open();
    void this.bench.stage.draw();
  }

  /** Returns the button that starts a tour. Returns undefined if none of its notes exists. */
  #tour(tour: StoredTour): HTMLButtonElement | undefined {
    const { make } = this.kit, { texts } = this.bench;
    const steps = tour.steps.map((step) => ({ ...step, note: this.#notes.findIndex(({ id }) => id === step.note) })).filter(({ note }) => note >= 0);
    if (steps.length === 0) return undefined;
    const title = tour.titles[languageIn(tour.titles, this.#language) ?? ""] ?? "";
    const start = () => this.#player.start(title, steps.map((step) => ({ ...step, index: step.note, note: this.#notes[step.note] as Annotation })), button);
    const button = make("button", { type: "button", class: "framed tour", onclick: start }, texts.tour.start(title));
    return button;
  }

  #entry(note: Annotation, i: number): HTMLLIElement {
    const { make } = this.kit, head = make("button", { type: "button", onclick: () => this.#choose(i) }, note.title);
    return make("li", note.language ? { lang: note.language } : {}, head, ...describe(make, note));
  }

  #button({ title }: Annotation, i: number): HTMLElement {
    const { make } = this.kit, label = this.bench.texts.noteMarker(i + 1, title);
    const button = make("button", { type: "button", "aria-label": label, onclick: () => this.#choose(i) }, make("span", {}, String(i + 1)));
    return make("div", { class: "marker" }, button);
  }

  /**
   * Shows the note that a link names, once the notes are loaded. Does not move the camera, because the link
   * also states the view.
   */
  #open(): void {
    const wanted = Number(this.#wanted) - 1;
    if (!this.#marks[wanted]) return;
    this.#mark(wanted);
    this.#wanted = "";
    this.kit.onChosen();
  }

  #choose(i: number): void {
    this.#player.end();
    this.#show(i, false);
    this.kit.onChosen();
    this.#list.children[i]?.scrollIntoView({ block: "nearest" });
  }

  /** Marks a note, and shows its view, light and section. */
  #show(i: number, isCut: boolean): void {
    const { orbit } = this.bench, { light, section } = this.kit, note = this.#notes[i] as Annotation, { point, normal } = this.#marks[i] as Mark;
    this.#mark(i);
    if (note.light) light.setting = note.light;
    if (note.section) section.setting = note.section;
    else if (note.section === "") section.reset?.();
    const view = note.view && this.#viewOf(note.view);
    if (view && isCut) orbit.view = view;
    else if (view) orbit.fly(view);
    // If the note has no normal, moves the camera to the side of the model on which the point is.
    else orbit.flyTo(normal ?? point);
  }

  #mark(chosen: number | undefined): void {
    [...this.#list.children].forEach((entry, i) => {
      if (i === chosen) entry.setAttribute("aria-current", "true");
      else entry.removeAttribute("aria-current");
    });
    this.#marks.forEach(({ element }, i) => element.classList.toggle("chosen", i === chosen));
  }

  /** Converts the view of a note to a view of the camera, which is in the coordinates of the presented (rotated and scaled) model. */
  #viewOf({ direction, target, zoom = 1 }: NoteView): OrbitView {
    const { stage } = this.bench, { mesh } = stage, at = target ? this.#onStage(target) : new Vector3();
    const toEye = new Vector3(...direction).applyQuaternion(mesh.quaternion).normalize();
    const { azimuth, elevation } = this.kit.anglesOf(toEye);
    return { azimuth, elevation, distance: stage.fittingDistance(at, toEye) / zoom, target: at.add(mesh.presentedCentre).toArray() };
  }

  /** Places the page's own hotspots. Each hotspot is an element of the page that is shown through a slot. */
  #pin(): void {
    const { make } = this.kit;
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
    const mark: Mark = { element, ...this.#spot(position, normal) };
    this.#places.set(mark, { position, normal });
    this.bench.overlay.add(mark);
    return mark;
  }

  #spot(position: Triple, normal: Triple | undefined): Omit<Mark, "element"> {
    const { mesh } = this.bench.stage;
    return { point: this.#onStage(position), ...(normal && { normal: new Vector3(...normal).applyQuaternion(mesh.quaternion) }) };
  }

  /** Converts a point from model coordinates to the coordinates of the stage's scene. */
  #onStage(position: Triple): Vector3 {
    const { mesh } = this.bench.stage;
    return new Vector3(...position).sub(new Vector3(...mesh.info.centre)).applyMatrix4(mesh.matrixWorld);
  }

  /** Converts a point from the coordinates of the stage's scene to model coordinates. */
  #inModel(point: Vector3): Triple {
    const { mesh } = this.bench.stage;
    return rounded(point.clone().applyMatrix4(mesh.matrixWorld.clone().invert()).add(new Vector3(...mesh.info.centre)));
  }

  #clear(marks: Mark[]): void {
    for (const mark of marks.splice(0)) {
      this.#places.delete(mark);
      this.bench.overlay.remove(mark);
    }
  }
}

function valueOf<T>(settled: PromiseSettledResult<T>, otherwise: T): T {
  return settled.status === "fulfilled" ? settled.value : otherwise;
}

/** Rounds so that no difference can be seen. */
function rounded(vector: Vector3): Triple {
  return vector.toArray().map((value) => Number(value.toPrecision(7))) as Triple;
}
