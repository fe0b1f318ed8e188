// SPDX-License-Identifier: Apache-2.0
// The form of a model's metadata. Unsaved texts are kept while the operator publishes, withdraws or replaces the model or visits other
// pages, until they are saved or discarded. Only changed fields are sent, so that the changes of two operators to different fields are
// both kept.
import { h } from "../ui/dom.ts";
import { kLicences, kRightsStatements, rightsLabel } from "../ui/rights.ts";
import { texts as gallery } from "../ui/texts/index.ts";
import { Alert, field, form, showFaults, type Values } from "./forms.ts";
import { Problem } from "./problem.ts";
import { texts } from "./texts/index.ts";
import type { ModelRecord } from "./types.ts";

const words = texts.model;
const kTexts = ["title", "creator", "contributor", "rights", "licence", "rights_statement", "description", "language", "type", "date", "period", "place",
  "coverage", "subject", "material", "technique", "collection", "identifier", "provenance", "persistent_identifier", "doi", "publisher", "source",
  "relation", "scan_device", "scan_calibration", "scan_date", "scan_software"] as const;
const kNames = [...kTexts, "unit", "accuracy", "public_max_level"] as const;
const kParagraphs: readonly string[] = ["description", "rights", "provenance"];
const kMaxLevel = 255;

type Name = (typeof kNames)[number];
/** The contents of the form's fields. */
type Contents = Record<Name, string>;

const kHints: Partial<Record<Name, string>> = {
  licence: texts.models.licenceHint, subject: words.severalHint, material: words.severalHint, period: words.severalHint, doi: words.doiHint,
  persistent_identifier: words.identifierHint, accuracy: words.accuracyHint, public_max_level: words.publicLevelHint,
};

export interface MetadataDraft {
  /** The fields that the operator has changed. */
  typed: Partial<Contents>;
  /** The stored metadata as last read. */
  stored: Contents;
  /** The fields that somebody else has changed meanwhile. */
  theirs: Name[];
}

export interface MetadataOptions {
  /** Unsaved changes by the model's ID. */
  drafts: Map<string, MetadataDraft>;
  /** Stores the changes. Rejects with status 412 if the model has changed since it was read. */
  save(changes: Values): Promise<unknown>;
  /** Reads the model again and calls show(). */
  reread(): Promise<void>;
  /** Called when the fields `names` have been stored, so that the model is read again and shown. */
  saved(names: readonly string[]): Promise<void>;
}

/** Returns the contents of the form's fields for a model. */
export function contentsOf(model: ModelRecord): Contents {
  return Object.fromEntries(kNames.map((name) => [name, String(model[name] ?? "")])) as Contents;
}

/**
 * Bases the draft on `stored`, the metadata that have been read now. Adds the fields that somebody else has changed to `theirs`, and
 * drops typed texts that are stored already. `own` are the fields that the operator has just stored.
 */
export function rebase(draft: MetadataDraft, stored: Contents, own: readonly string[] = []): void {
  const changed = kNames.filter((name) => stored[name] !== draft.stored[name] && !own.includes(name));
  draft.theirs = [...new Set([...draft.theirs, ...changed])];
  draft.stored = stored;
  for (const name of kNames) if (draft.typed[name]?.trim() === stored[name]) delete draft.typed[name];
}

export class MetadataForm {
  readonly element = h("section", { class: "card" });
  readonly #said = h("p", { role: "status", tabindex: -1 });
  readonly #discard = h("button", { type: "button", onclick: () => this.#discardAll() }, words.discard);
  readonly #alert = new Alert();
  #form = h("form");
  #isSaving = false;
  #model: ModelRecord | undefined;

  constructor(private readonly options: MetadataOptions) {
    this.element.addEventListener("input", ({ target }) => this.#keep(target as HTMLInputElement));
  }

  /** Shows a state of the model, with the unsaved texts. `own` are the fields that the operator has just stored. */
  show(model: ModelRecord, own: readonly string[] = []): void {
    this.#model = model;
    const draft = this.#draft;
    if (draft) rebase(draft, contentsOf(model), own);
    this.#dropIfEmpty();
    this.#said.textContent = "";
    this.#alert.clear();
    this.#form = form([...this.#fields(model), this.#said], words.save, (values) => this.#save(values), "", this.#alert);
    this.#form.querySelector(".actions:has([type=submit])")?.append(this.#discard);
    this.element.replaceChildren(h("h2", {}, words.metadata), this.#form);
    this.#tell();
  }

  get #id(): string {
    return this.#model?.id ?? "";
  }

  get #draft(): MetadataDraft | undefined {
    return this.options.drafts.get(this.#id);
  }

  #fields(model: ModelRecord): HTMLElement[] {
    const draft = this.#draft, contents: Contents = { ...contentsOf(model), ...draft?.typed };
    const units: [string, string][] = [["", words.unknownUnit], ...Object.entries(gallery.units)];
    // A text of somebody else that the operator is about to replace stands below its field.
    const hint = (name: Name) => (draft?.theirs.includes(name) && name in draft.typed ? words.storedNow(draft.stored[name]) : kHints[name]);
    const one = (name: Name, more: Partial<Parameters<typeof field>[0]> = {}) => {
      const note = hint(name);
      return field({ name, value: contents[name], label: label(name), ...(note ? { hint: note } : {}), ...more });
    };
    const text = (name: (typeof kTexts)[number]) => one(name, {
      ...(kParagraphs.includes(name) ? { type: "textarea" as const } : {}),
      ...(name === "licence" ? { suggestions: kLicences } : {}),
      ...(name === "rights_statement" ? { options: statementsWith(contents[name]) } : {}),
    });
    return [...kTexts.map(text), one("unit", { options: units }), one("accuracy", { type: "number", step: "any", min: 0 }),
      one("public_max_level", { type: "number", min: 0, max: kMaxLevel })];
  }

  /** Keeps what the operator has entered into a field. */
  #keep({ name, value }: { name: string; value: string }): void {
    if (!this.#model) return;
    const stored = contentsOf(this.#model), draft = this.#draft ?? { typed: {}, stored, theirs: [] };
    this.options.drafts.set(this.#id, draft);
    if (value.trim() === stored[name as Name]) delete draft.typed[name as Name];
    else draft.typed[name as Name] = value;
    this.#dropIfEmpty();
    this.#enable();
  }

  #dropIfEmpty(): void {
    if (this.#draft && Object.keys(this.#draft.typed).length === 0) this.options.drafts.delete(this.#id);
  }

  /** Says that there are unsaved texts, and which fields somebody else has changed. */
  #tell(): void {
    const theirs = this.#draft?.theirs ?? [];
    this.#said.className = theirs.length > 0 ? "alert" : "quiet";
    if (this.#draft) this.#said.textContent = theirs.length > 0 ? words.outdated(theirs.map(label).join(", ")) : texts.presentation.restored;
    this.#enable();
  }

  /** Enables saving if there are unsaved texts, but not during a save: a second save would send the entity tag that the first one changes. */
  #enable(): void {
    this.#discard.hidden = !this.#draft;
    (this.#form.querySelector("[type=submit]") as HTMLButtonElement).disabled = this.#isSaving || !this.#draft;
  }

  #discardAll(): void {
    this.options.drafts.delete(this.#id);
    if (this.#model) this.show(this.#model);
  }

  /** Stores the changed fields. Shows an error in the present form, because show() may have replaced the form that was submitted. */
  async #save(values: Values): Promise<void> {
    this.#isSaving = true;
    try {
      await this.#store(values);
    } catch (error) {
      showFaults(error, this.#alert, this.#form);
    } finally {
      this.#isSaving = false;
      this.#enable();
    }
  }

  /**
   * Stores the changed fields. If somebody else has changed fields meanwhile, names these instead, so that the operator sees them
   * before storing the changes.
   */
  async #store(values: Values): Promise<void> {
    const draft = this.#draft;
    if (!draft) return;
    const sent = { ...draft.typed }, names = Object.keys(sent) as Name[];
    const changes = Object.fromEntries(names.map((name) => [name, values[name] ?? null]));
    draft.theirs = [];
    try {
      await this.options.save(changes);
    } catch (error) {
      if (!(error instanceof Problem) || error.status !== 412) throw error;
      await this.options.reread();
      if (this.#draft?.theirs.length) return this.#said.focus();
      await this.options.save(changes); // the form shows nothing of what has changed, such as the notes
    }
    draft.theirs = [];
    for (const name of names) if (draft.typed[name] === sent[name]) delete draft.typed[name];
    this.#dropIfEmpty();
    await this.options.saved(names);
  }
}

/** Returns the choices of rights statements, with the present value, which may have another form of the address. */
function statementsWith(uri: string): [string, string][] {
  const all: [string, string][] = [["", words.noStatement], ...kRightsStatements.map(([known, name]): [string, string] => [known, name])];
  return all.some(([known]) => known === uri) ? all : [...all, [uri, rightsLabel(uri)]];
}

function label(name: Name): string {
  if (name === "title") return gallery.title;
  if (name === "description") return words.description;
  return name === "public_max_level" ? words.publicLevel : gallery.facts[name];
}
