// SPDX-License-Identifier: Apache-2.0
// The form of one note: its texts in one language at a time, picture and sound.
import type { NoteText, StoredNote } from "../element/notes/annotations.ts";
import type { Kit } from "./presentation.ts";

const kLanguages = ["en", "de", "fr", "es", "it"];
const kTexts = ["title", "text", "alt", "audio"] as const;

/** Returns an ID for a new note or tour. */
export function newId(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(6)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

/**
 * Replaces the entries of a list. The focus stays at the control of the same name, and in the same entry if several entries had
 * such a control. If the control is gone or disabled, the next enabled one gets the focus.
 */
export function refill(list: HTMLElement, entries: HTMLElement[]): void {
  const focused = list.contains(document.activeElement) ? (document.activeElement as HTMLElement) : undefined;
  const entry = [...list.children].findIndex((one) => one.contains(focused ?? null)), at = focused ? controlsIn(list.children[entry]).indexOf(focused) : -1;
  const name = focused && nameOf(focused), isUnique = controlsIn(list).filter((control) => nameOf(control) === name).length === 1;
  list.replaceChildren(...entries);
  if (name !== undefined) successor(list, isUnique, entry, at, name)?.focus();
}

function successor(list: HTMLElement, isUnique: boolean, entry: number, at: number, name: string): HTMLElement | undefined {
  const sameEntry = controlsIn(list.children[entry]), isSame = (control: HTMLElement) => nameOf(control) === name;
  const same = sameEntry.find(isSame) ?? (isUnique ? controlsIn(list).find(isSame) : undefined);
  if (same && !same.matches(":disabled")) return same;
  const around = same ? controlsIn([...list.children].find((one) => one.contains(same))) : sameEntry, from = same ? around.indexOf(same) : at;
  const all = [...around.slice(from), ...around.slice(0, Math.max(from, 0)).reverse(), ...controlsIn(list), ...controlsIn(list.parentElement)];
  return all.find((control) => !control.matches(":disabled"));
}

function controlsIn(element: Element | null | undefined): HTMLElement[] {
  return [...(element?.querySelectorAll<HTMLElement>("button, input, select") ?? [])];
}

function nameOf(control: HTMLElement): string {
  return control.ariaLabel ?? (control.getAttribute("name") || (control.textContent ?? ""));
}

interface NoteActions {
  changed(note: StoredNote): void;
  takeView(): void;
  move(): void;
  remove(): void;
}

export class NoteForm {
  readonly element: HTMLElement;
  /** The note that the form changes. */
  note: StoredNote | undefined;
  readonly #languages: HTMLSelectElement;

  constructor(private readonly kit: Kit, private readonly actions: NoteActions) {
    const { h, field, texts: { notes: words } } = kit;
    const languages = field({ name: "language", label: words.language, hint: words.languageHint, options: [] });
    this.#languages = languages.querySelector("select") as HTMLSelectElement;
    this.#languages.addEventListener("change", () => this.fill());
    this.element = h("div", { class: "note-form", hidden: true, role: "group", "aria-label": words.note }, languages,
      field({ name: "title", label: words.titleOf }), field({ name: "text", label: words.text, hint: words.textHint, type: "textarea" }),
      field({ name: "picture", label: words.picture, hint: words.urlHint }), field({ name: "alt", label: words.alt }), field({ name: "audio", label: words.audio, hint: words.urlHint }),
      h("div", { class: "actions" }, h("button", { type: "button", onclick: () => actions.takeView() }, words.takeView),
        h("button", { type: "button", onclick: () => actions.move() }, words.move), h("button", { type: "button", class: "danger", onclick: () => actions.remove() }, words.remove)));
    this.element.addEventListener("input", (event) => event.target !== this.#languages && this.#read());
    this.#offer([]);
  }

  get language(): string {
    return this.#languages.value;
  }
  set language(tag: string) {
    this.#offer([tag]);
    this.#languages.value = tag;
  }

  /** Returns the title of a note in the chosen language or, if it has none, in its first language. */
  titleOf({ texts }: StoredNote): string {
    return (texts[this.language] ?? Object.values(texts)[0])?.title ?? "";
  }

  /** Fills the form with the texts of the note. Hides the form if there is no note. */
  fill(): void {
    this.element.hidden = !this.note;
    if (!this.note) return;
    this.#offer(Object.keys(this.note.texts));
    const text = this.note.texts[this.language];
    for (const name of kTexts) this.#control(name).value = text?.[name] ?? "";
    this.#control("picture").value = this.note.picture ?? "";
  }

  focus(): void {
    this.#control("title").focus();
    (this.#control("title") as HTMLInputElement).select();
  }

  /** Offers the usual languages and those of `more`. Keeps the chosen language. */
  #offer(more: string[]): void {
    const { h, language } = this.kit, chosen = this.#languages.value || language;
    const names = new Intl.DisplayNames(language, { type: "language", fallback: "code" });
    const all = [...new Set([...kLanguages, ...more])];
    this.#languages.replaceChildren(...all.map((tag) => h("option", { value: tag, selected: tag === chosen }, names.of(tag) ?? tag)));
  }

  #control(name: string): HTMLInputElement | HTMLTextAreaElement {
    return this.element.querySelector(`[name=${name}]`) as HTMLInputElement;
  }

  #read(): void {
    if (!this.note) return;
    const entries = kTexts.map((name) => [name, this.#control(name).value] as const).filter(([, value]) => value !== "");
    const texts = { ...this.note.texts }, picture = this.#control("picture").value.trim();
    // A language without any text is left out, unless it is the only one.
    if (entries.length > 0 || Object.keys(texts).every((tag) => tag === this.language)) texts[this.language] = { title: "", ...Object.fromEntries(entries) } as NoteText;
    else delete texts[this.language];
    const { picture: _, ...rest } = this.note;
    this.actions.changed({ ...rest, texts, ...(picture && { picture }) });
  }
}
