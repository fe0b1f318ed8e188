// SPDX-License-Identifier: Apache-2.0
// The form of the tours through a model's notes: their titles, and the order of their steps.
import type { StoredTour } from "../element/notes/annotations.ts";
import type { NoteDocuments } from "../element/notes/note-reader.ts";
import { newId, refill } from "./note-form.ts";
import type { Kit } from "./presentation.ts";

type Step = StoredTour["steps"][number];

export class TourForm {
  readonly element: HTMLElement;
  readonly #tours: HTMLElement;
  #now: NoteDocuments = { notes: [], tours: [] };

  constructor(private readonly kit: Kit, private readonly changed: (tours: StoredTour[]) => void) {
    const { h, texts: { notes: words } } = kit;
    this.#tours = h("div", { class: "tours" });
    this.element = h("fieldset", {}, h("legend", {}, words.tours), h("p", { class: "quiet" }, words.toursHint), this.#tours,
      h("div", { class: "actions" }, h("button", { type: "button", onclick: () => this.#add() }, words.newTour)));
  }

  /** Shows the tours. Keeps the fields if only their values have changed, because the operator types in them. */
  show(now: NoteDocuments, isOther: boolean): void {
    const shape = ({ notes, tours }: NoteDocuments) => JSON.stringify([notes.map(({ id, texts }) => [id, texts]), tours.map(({ id, titles, steps }) => [id, Object.keys(titles), steps.map(({ note }) => note)])]);
    const isSame = !isOther && shape(now) === shape(this.#now);
    this.#now = now;
    if (!isSame) refill(this.#tours, now.tours.map((tour, i) => this.#tour(tour, i)));
  }

  #add(): void {
    const { language, texts: { notes: words } } = this.kit, { notes, tours } = this.#now;
    this.changed([...tours, { id: newId(), titles: { [language]: words.untitledTour }, steps: notes.map(({ id }) => ({ note: id })) }]);
    (this.#tours.lastElementChild?.querySelector("input") as HTMLInputElement | null)?.select();
  }

  #replace(i: number, change: (tour: StoredTour) => StoredTour | undefined): void {
    this.changed(this.#now.tours.flatMap((tour, at) => (at === i ? (change(tour) ?? []) : tour)));
  }

  #tour(tour: StoredTour, i: number): HTMLElement {
    const { h, texts: { notes: words } } = this.kit;
    const titles = Object.entries(tour.titles).map(([tag, title]) => this.#title(i, tag, title));
    const steps = tour.steps.map((step, at) => this.#step(i, tour, step, at));
    const add = () => this.#replace(i, (old) => ({ ...old, steps: [...old.steps, { note: (this.#now.notes[0] as { id: string }).id }] }));
    const missing = ["en", "de", "fr", "es", "it"].find((tag) => !(tag in tour.titles));
    const language = () => {
      if (missing) this.#replace(i, (old) => ({ ...old, titles: { ...old.titles, [missing]: Object.values(old.titles)[0] ?? "" } }));
    };
    return h("div", { class: "tour", role: "group", "aria-label": words.tour(i + 1) }, ...titles, h("ol", { class: "steps" }, ...steps),
      h("div", { class: "actions" }, h("button", { type: "button", disabled: this.#now.notes.length === 0, onclick: add }, words.addStep),
        h("button", { type: "button", disabled: missing === undefined, onclick: language }, words.addLanguage),
        h("button", { type: "button", class: "danger", onclick: () => this.#replace(i, () => undefined) }, words.removeTour)));
  }

  #title(i: number, tag: string, title: string): HTMLElement {
    const { field, language, texts: { notes: words } } = this.kit;
    const name = new Intl.DisplayNames(language, { type: "language", fallback: "code" }).of(tag) ?? tag;
    const made = field({ name: tag, label: words.tourTitle(name), value: title });
    made.addEventListener("input", ({ target }) => this.#replace(i, (old) => ({ ...old, titles: { ...old.titles, [tag]: (target as HTMLInputElement).value } })));
    return made;
  }

  #step(i: number, tour: StoredTour, step: Step, at: number): HTMLElement {
    const { h, language, texts: { notes: words } } = this.kit, number = at + 1;
    const change = (part: Partial<Step>) => this.#replace(i, (old) => ({ ...old, steps: old.steps.map((one, j) => (j === at ? without({ ...one, ...part }) : one)) }));
    const titleOf = (texts: Record<string, { title: string }>) => (texts[language] ?? Object.values(texts)[0])?.title ?? "";
    const note = h("select", { "aria-label": words.stepNote(number), onchange: () => change({ note: note.value }) },
      ...this.#now.notes.map(({ id, texts }) => h("option", { value: id, selected: id === step.note }, titleOf(texts))));
    const seconds = h("input", { type: "number", min: 1, max: 600, step: "any", "aria-label": words.stepSeconds(number), placeholder: words.automatic, value: step.seconds ?? "",
      oninput: () => change({ seconds: Number(seconds.value) }) });
    const transition = h("select", { "aria-label": words.stepTransition(number), onchange: () => change({ transition: transition.value as "fly" | "cut" }) },
      ...(["fly", "cut"] as const).map((way) => h("option", { value: way, selected: way === step.transition }, words.transitions[way])));
    const move = (by: number, label: string, sign: string) =>
      h("button", { type: "button", class: "plain", "aria-label": label, disabled: !tour.steps[at + by], onclick: () => this.#replace(i, (old) => ({ ...old, steps: swapped(old.steps, at, at + by) })) }, sign);
    const remove = h("button", { type: "button", class: "plain", "aria-label": words.removeStep(number), onclick: () => this.#replace(i, (old) => ({ ...old, steps: old.steps.filter((_, j) => j !== at) })) }, "×");
    return h("li", {}, note, seconds, transition, move(-1, words.earlierStep(number), "↑"), move(1, words.laterStep(number), "↓"), remove);
  }
}

/** Leaves out an empty time. The tour then shows the note long enough to read it. */
function without({ seconds, ...rest }: Step): Step {
  return seconds ? { ...rest, seconds } : rest;
}

function swapped<T>(list: T[], i: number, j: number): T[] {
  return list.map((value, at) => (at === i ? (list[j] as T) : at === j ? (list[i] as T) : value));
}
