// SPDX-License-Identifier: Apache-2.0
// Edits the notes on a model and the tours through them. The viewer shows changes at once. They are kept while the operator visits
// other pages, until they are saved or discarded.
import type { StoredNote, StoredTour } from "../element/notes/annotations.ts";
import type { NoteDocuments, NoteReader } from "../element/notes/note-reader.ts";
import { readNoteFile, type SceneScale } from "./iiif-notes.ts";
import { NoteForm, newId, refill } from "./note-form.ts";
import type { Kit } from "./presentation.ts";
import { TourForm } from "./tour-form.ts";

export type NotePart = keyof NoteDocuments;

export interface NotesOptions {
  /** Unsaved changes by the model's ID. */
  drafts: Map<string, NotesDraft>;
  id: string;
  /** Name for saved files. */
  title: string;
  /** Returns the present scale. The operator may change it while the editor is open. */
  scale(): SceneScale;
  /** The element that contains the viewer. */
  stage: HTMLElement;
  signal: AbortSignal;
  read(part: NotePart): Promise<{ value: Partial<NoteDocuments>; tag: string }>;
  /** Stores one part and resolves to its new entity tag. Rejects if the daemon refuses it. */
  save(part: NotePart, documents: Partial<NoteDocuments>, tag: string): Promise<string>;
  saved(): void;
}

const kParts = ["notes", "tours"] as const;
const kStill = 5; // pixels that the pointer may move during a click

/** Unsaved changes, and the entity tags of the stored documents on which they are based. */
export interface NotesDraft {
  documents: NoteDocuments;
  tags: Record<NotePart, string>;
}

export class NotesEditor {
  readonly element: HTMLElement;
  readonly #form: HTMLFormElement;
  readonly #list: HTMLOListElement;
  readonly #noteForm: NoteForm;
  readonly #tourForm: TourForm;
  readonly #place: HTMLButtonElement;
  readonly #discard: HTMLButtonElement;
  readonly #said: HTMLElement;
  readonly #tags: Record<NotePart, string> = { notes: "", tours: "" };
  #saving: Promise<void> = Promise.resolve();
  #saved: NoteDocuments = { notes: [], tours: [] };
  #now: NoteDocuments = { notes: [], tours: [] };
  #chosen = ""; // ID of the note in the form
  #moved = ""; // ID of the note that the next click moves

  constructor(private readonly kit: Kit, private readonly options: NotesOptions) {
    const { h, form, texts } = kit, words = texts.notes;
    this.#list = h("ol", { class: "note-list" });
    this.#said = h("p", { class: "quiet", role: "status" });
    this.#place = h("button", { type: "button", "aria-pressed": "false", onclick: () => (this.#isPlacing = !this.#isPlacing) }, words.place);
    const middle = h("button", { type: "button", onclick: () => void this.#attempt(() => this.#putInMiddle()) }, words.placeMiddle);
    this.#noteForm = new NoteForm(kit, {
      changed: (note) => this.#replace(note),
      takeView: () => void this.#attempt(() => this.#takeView()),
      move: () => this.#move(),
      remove: () => this.#remove(),
    });
    this.#tourForm = new TourForm(kit, (tours) => this.#change({ ...this.#now, tours }));
    const file = h("input", { type: "file", accept: ".json,application/json,application/ld+json", hidden: true, onchange: () => void this.#import(file) });
    this.#discard = h("button", { type: "button", onclick: () => this.#dismiss() }, words.discard);
    this.#form = form([
      h("fieldset", {}, h("legend", {}, words.notes), h("p", { class: "quiet" }, words.hint), h("div", { class: "actions" }, this.#place, middle), this.#said, this.#list, this.#noteForm.element),
      this.#tourForm.element,
      h("fieldset", {}, h("legend", {}, words.files), h("p", { class: "quiet" }, words.filesHint), h("div", { class: "actions" },
        h("button", { type: "button", onclick: () => this.#export() }, words.exportFile), h("button", { type: "button", onclick: () => file.click() }, words.importFile), file)),
    ], words.save, () => this.#save());
    this.#form.querySelector(".actions:has([type=submit])")?.append(this.#discard);
    this.element = h("div", { class: "presentation notes-editor" }, this.#form);
  }

  /** Reads the stored notes and tours. Continues with unsaved changes, if there are any. */
  async open(): Promise<void> {
    await this.#read();
    this.#change(this.options.drafts.get(this.options.id)?.documents ?? this.#saved, true);
    this.#listen();
    const draft = this.options.drafts.get(this.options.id); // #change() removes a draft that equals the stored documents
    if (!draft) return;
    const isOutdated = kParts.some((part) => draft.tags[part] !== this.#tags[part]);
    this.#said.textContent = isOutdated ? this.kit.texts.notes.outdated : this.kit.texts.presentation.restored;
  }

  /** Ends the placing of notes, because the operator closes the editor. */
  rest(): void {
    if (this.#isPlacing) this.#isPlacing = false;
  }

  async #read(): Promise<void> {
    const [notes, tours] = await Promise.all(kParts.map((part) => this.options.read(part)));
    this.#tags.notes = notes?.tag ?? "";
    this.#tags.tours = tours?.tag ?? "";
    this.#saved = { notes: notes?.value.notes ?? [], tours: tours?.value.tours ?? [] };
  }

  #dismiss(): void {
    this.#said.textContent = "";
    this.#change(this.#saved, true);
  }

  #listen(): void {
    const { stage, signal } = this.options, options = { signal, capture: true };
    let down: PointerEvent | undefined;
    stage.addEventListener("pointerdown", (event) => (down = event.button === 0 ? event : undefined), options);
    stage.addEventListener("pointerup", (event) => {
      const isClick = down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < kStill;
      const isPlace = this.#isPlacing && isClick && event.button === 0 && event.composedPath()[0] instanceof HTMLCanvasElement;
      if (isPlace) void this.#attempt(() => this.#put(event.clientX, event.clientY));
    }, options);
    // A new viewer shows the saved notes at first, so the unsaved ones are shown again.
    stage.addEventListener("load", () => void this.#preview(), options);
  }

  get #isPlacing(): boolean {
    return this.#place.ariaPressed === "true";
  }
  set #isPlacing(on: boolean) {
    const words = this.kit.texts.notes;
    this.#place.ariaPressed = String(on);
    this.options.stage.classList.toggle("measuring", on);
    if (!on) this.#moved = "";
    this.#said.textContent = on ? (this.#moved ? words.clickMove : words.click) : "";
  }

  /** Runs `act`, which needs the viewer. If `act` fails, tells the operator that the viewer is not ready. */
  async #attempt(act: () => Promise<void>): Promise<void> {
    await act().catch(() => (this.#said.textContent = this.kit.texts.notes.noViewer));
  }

  #reader(): Promise<NoteReader> {
    return this.options.stage.querySelector("progressive-mesh")?.presenter?.noteReader() ?? Promise.reject(new Error(this.kit.texts.notes.noViewer));
  }

  #putInMiddle(): Promise<void> {
    const canvas = this.options.stage.querySelector("progressive-mesh")?.shadowRoot?.querySelector("canvas");
    const { left, top, width, height } = (canvas ?? this.options.stage).getBoundingClientRect();
    return this.#put(left + width / 2, top + height / 2);
  }

  /** Places a note on the surface at a point of the window: the note that is being moved, or a new one. */
  async #put(x: number, y: number): Promise<void> {
    const reader = await this.#reader(), place = reader.pick(x, y), words = this.kit.texts.notes;
    if (!place) return void (this.#said.textContent = words.missed);
    const moved = this.#now.notes.find(({ id }) => id === this.#moved), { moment } = reader;
    this.#isPlacing = false;
    if (moved) return this.#replace({ ...moved, ...place });
    const note: StoredNote = { id: newId(), ...place, ...moment, texts: { [this.#noteForm.language]: { title: words.untitled(this.#now.notes.length + 1) } } };
    this.#chosen = note.id;
    this.#change({ ...this.#now, notes: [...this.#now.notes, note] }, true);
    this.#noteForm.focus();
  }

  async #takeView(): Promise<void> {
    const { moment } = await this.#reader(), note = this.#note;
    if (!note) return;
    this.#replace({ ...note, ...moment });
    this.#said.textContent = this.kit.texts.notes.viewTaken;
  }

  #move(): void {
    this.#moved = this.#chosen;
    this.#isPlacing = true;
  }

  #remove(): void {
    this.rest();
    const gone = this.#chosen;
    this.#chosen = "";
    const tours = this.#now.tours.map((tour) => ({ ...tour, steps: tour.steps.filter(({ note }) => note !== gone) }));
    this.#change({ notes: this.#now.notes.filter(({ id }) => id !== gone), tours }, true);
    this.#place.focus();
  }

  get #note(): StoredNote | undefined {
    return this.#now.notes.find(({ id }) => id === this.#chosen);
  }

  #replace(note: StoredNote): void {
    this.#change({ ...this.#now, notes: this.#now.notes.map((one) => (one.id === note.id ? note : one)) });
  }

  #swap(i: number, j: number): void {
    const notes = [...this.#now.notes], [a, b] = [notes[i], notes[j]];
    if (!a || !b) return;
    [notes[i], notes[j]] = [b, a];
    this.#change({ ...this.#now, notes });
  }

  /** Shows the documents `now`. Fills the forms again only if `isOther` is true: otherwise, the operator is typing in them. */
  #change(now: NoteDocuments, isOther = false): void {
    this.#now = now;
    const isSame = JSON.stringify(now) === JSON.stringify(this.#saved);
    if (isSame) this.options.drafts.delete(this.options.id);
    else this.options.drafts.set(this.options.id, { documents: now, tags: this.options.drafts.get(this.options.id)?.tags ?? { ...this.#tags } });
    this.#discard.disabled = isSame;
    (this.#form.querySelector("[type=submit]") as HTMLButtonElement).disabled = isSame;
    this.#noteForm.note = this.#note;
    if (isOther) this.#noteForm.fill();
    refill(this.#list, now.notes.map((note, i) => this.#row(note, i)));
    this.#tourForm.show(now, isOther);
    void this.#preview();
  }

  #row(note: StoredNote, i: number): HTMLElement {
    const { h, texts: { notes: words } } = this.kit, title = this.#noteForm.titleOf(note), isChosen = note.id === this.#chosen;
    const choose = () => {
      this.#chosen = isChosen ? "" : note.id;
      this.#change(this.#now, true);
      if (!isChosen) this.#noteForm.focus();
    };
    const shift = (by: number, label: string, sign: string) =>
      h("button", { type: "button", class: "plain", "aria-label": label, disabled: !this.#now.notes[i + by], onclick: () => this.#swap(i, i + by) }, sign);
    return h("li", {}, h("button", { type: "button", class: "plain name", "aria-expanded": String(isChosen), onclick: choose }, title),
      shift(-1, words.earlier(title), "↑"), shift(1, words.later(title), "↓"));
  }

  async #preview(): Promise<void> {
    // Without a viewer, the notes can still be edited.
    await this.#reader().then((reader) => reader.preview(this.#now), () => undefined);
  }

  /** Saves after an earlier call has ended, so that both use the newest entity tags. */
  #save(): Promise<void> {
    return (this.#saving = this.#saving.catch(() => undefined).then(() => this.#store()));
  }

  async #store(): Promise<void> {
    this.#change({ ...this.#now, tours: this.#now.tours.map(withoutEmptyTitles) });
    try {
      for (const part of kParts) {
        const sent = this.#now[part]; // the operator may change `now` during the request
        if (JSON.stringify(sent) === JSON.stringify(this.#saved[part])) continue;
        const tag = (this.#tags[part] = await this.options.save(part, { [part]: sent }, this.#tags[part]));
        this.#saved = { ...this.#saved, [part]: sent };
        const draft = this.options.drafts.get(this.options.id);
        if (draft) draft.tags[part] = tag;
      }
    } catch (error) {
      if ((error as { status?: number }).status === 412) await this.#refresh();
      this.#showFault(error);
      throw error;
    }
    this.#change(this.#now);
    this.#said.textContent = "";
    this.options.saved();
  }

  /**
   * Reads the notes and tours that somebody else has stored meanwhile. The operator can then replace them by saving again, or see
   * them by discarding the unsaved changes.
   */
  async #refresh(): Promise<never> {
    await this.#read();
    this.#change(this.#now);
    throw new Error(this.kit.texts.notes.outdated);
  }

  /**
   * Opens the note and the language that the first fault of the error names. Removes all faults of other notes and languages
   * from the error, because the form does not show their fields.
   */
  #showFault(error: unknown): void {
    const { faults } = error as { faults?: { parameter: string }[] }, [, number, language] = placeOf(faults?.[0]?.parameter);
    const note = number === undefined ? undefined : this.#now.notes[Number(number)];
    if (!faults || !note) return;
    const tag = language ?? placeOf(faults.find(({ parameter }) => placeOf(parameter)[1] === number && placeOf(parameter)[2])?.parameter)[2];
    const shown = faults.filter(({ parameter }) => {
      const [, ofNumber, ofLanguage] = placeOf(parameter);
      return ofNumber === number && (ofLanguage === undefined || ofLanguage === tag);
    });
    faults.splice(0, faults.length, ...shown);
    this.#chosen = note.id;
    if (tag !== undefined) this.#noteForm.language = tag;
    this.#change(this.#now, true);
  }

  #export(): void {
    const address = URL.createObjectURL(new Blob([JSON.stringify(this.#now, null, 1)], { type: "application/json" }));
    this.kit.h("a", { href: address, download: `${this.options.title || "model"}.notes.json` }).click();
    URL.revokeObjectURL(address);
  }

  async #import(input: HTMLInputElement): Promise<void> {
    const file = input.files?.[0], words = this.kit.texts.notes;
    input.value = "";
    if (!file) return;
    try {
      const read = readNoteFile(await file.text(), this.options.scale(), newId, words.noNotes);
      this.#chosen = "";
      this.#change(read.isWhole ? { notes: read.notes, tours: read.tours } : { ...this.#now, notes: [...this.#now.notes, ...read.notes] }, true);
      this.#said.textContent = words.imported(read.notes.length);
    } catch (error) {
      this.#said.textContent = (error as Error).message;
    }
  }
}

/** Splits the path of a fault. Returns the matched text, the number of the note, and the language if the path names one. */
function placeOf(parameter = ""): string[] {
  return /^notes\.(\d+)(?:\.texts\.([^.]+))?/.exec(parameter) ?? [];
}

/** Leaves out the languages in which a tour has no title. A tour keeps at least one language. */
function withoutEmptyTitles(tour: StoredTour): StoredTour {
  const titles = Object.entries(tour.titles), named = titles.filter(([, title]) => title !== "");
  return { ...tour, titles: Object.fromEntries(named.length > 0 ? named : titles.slice(0, 1)) };
}
