// SPDX-License-Identifier: Apache-2.0
// The page "#/models/{id}" of a model: viewer, metadata, visibility, build report and repairs.
import { snippet } from "../ui/about.ts";
import { copyable } from "../ui/copy.ts";
import { h } from "../ui/dom.ts";
import { count, date, size, texts as gallery } from "../ui/texts/index.ts";
import type { ConsolePage, Visit } from "./desk.ts";
import { forgetDrafts, guardDrafts, newDrafts } from "./drafts.ts";
import { Alert, button, field, form, isConfirmed } from "./forms.ts";
import { levelReport } from "./levels.ts";
import { MetadataForm, type MetadataDraft } from "./metadata.ts";
import type { NotePart, NotesDraft, NotesEditor } from "./notes.ts";
import type { Placed, PresentationEditor } from "./presentation.ts";
import { Problem } from "./problem.ts";
import { facts, heading, modelBadge, repairList } from "./parts.ts";
import { language, texts } from "./texts/index.ts";
import type { Manifest, ModelRecord } from "./types.ts";
import { cardOf, dropZone } from "./upload-card.ts";

const words = texts.model;
const drafts = { metadata: newDrafts<MetadataDraft>(), presentation: newDrafts<Placed>(), notes: newDrafts<NotesDraft>() };
guardDrafts();

/**
 * Creates a viewer that shows the model. For a draft, the viewer sends the operator's token, and a
 * hint is shown below.
 */
export function sight({ desk }: Visit, { state, title, links }: ModelRecord): HTMLElement {
  const viewer = document.createElement("progressive-mesh"), isDraft = state !== "published";
  if (isDraft) Object.assign(viewer, { token: desk.api.token });
  viewer.setAttribute("src", links.self);
  viewer.setAttribute("alt", title || gallery.untitled);
  viewer.toggleAttribute("camera-controls", true);
  return h("div", { class: "sight" }, viewer, isDraft && h("p", { class: "quiet" }, words.draftHint));
}

class ModelEditor {
  readonly #path: string;
  readonly #stage = h("div", { class: "stage-box" });
  readonly #side = h("section", { class: "side" });
  readonly #report = h("section", { class: "card", hidden: true });
  readonly #repairs = h("section", { class: "card", hidden: true });
  readonly #metadata: MetadataForm;
  readonly #setting = h("details", { class: "card setting", ontoggle: () => void this.#openSetting() }, h("summary", {}, words.setting));
  readonly #noting = h("details", { class: "card setting noting", ontoggle: () => void this.#openNotes() }, h("summary", {}, texts.notes.title));
  #editor: PresentationEditor | undefined;
  #notes: NotesEditor | undefined;
  #openingNotes: Promise<void> | undefined; // while the editor of notes is being loaded
  readonly #title = h("h1", { tabindex: -1 });
  readonly #state = h("span");
  #tag = "";
  #model: ModelRecord | undefined;
  #shown = ""; // state of the model when the viewer was created

  constructor(private readonly visit: Visit, private readonly id: string) {
    this.#path = `/models/${id}`;
    this.#metadata = new MetadataForm({
      drafts: drafts.metadata,
      save: (changes) => visit.desk.api.send("PATCH", this.#path, changes, this.#tag),
      reread: async () => this.#show(await this.#read()),
      saved: (names) => this.#saved(names),
    });
  }

  async open(): Promise<string> {
    const { view } = this.visit, model = await this.#firstRead();
    view.append(h("header", { class: "heading" }, this.#title, this.#state),
      h("div", { class: "columns wide" }, h("div", {}, this.#stage, this.#setting, this.#noting, this.#report, this.#repairs, this.#replacing()), h("div", {}, this.#side, this.#metadata.element)));
    this.#show(model);
    void this.#showLevels();
    return model.title || gallery.untitled;
  }

  /** Reads the model when the page is opened. Discards the unsaved changes of a model that somebody has deleted: no page shows them. */
  async #firstRead(): Promise<ModelRecord> {
    try {
      return await this.#read();
    } catch (error) {
      if (error instanceof Problem && error.status === 404) forgetDrafts(this.id);
      throw error;
    }
  }

  async #read(): Promise<ModelRecord> {
    const { value, tag } = await this.visit.desk.api.tagged<ModelRecord>(this.#path, this.visit.signal);
    this.#tag = tag;
    this.#model = value;
    return value;
  }

  /** Shows the build report. Hides it if the manifest cannot be loaded. */
  async #showLevels(): Promise<void> {
    const { desk, signal } = this.visit;
    const report = await desk.api.get<Manifest>(`${this.#path}/manifest`, signal).then(levelReport, () => []);
    this.#report.hidden = report.length === 0;
    this.#report.replaceChildren(...report);
  }

  /** Waits for the change `act`, then reads the model from the daemon again and shows it. */
  async #changed(act: Promise<unknown>): Promise<void> {
    await act;
    this.#show(await this.#read());
    this.#title.focus();
  }

  /** Shows the model after the fields `names` of its metadata have been stored. */
  async #saved(names: readonly string[]): Promise<void> {
    this.#show(await this.#read(), names);
    this.#title.focus();
    this.visit.desk.say(words.saved);
  }

  /** Makes the viewer show the new file after the model's file was replaced. */
  async #again(): Promise<void> {
    this.#shown = "";
    this.#show(await this.#read());
    await this.#showLevels();
  }

  /** Loads the editor of the presentation when it is first opened. */
  async #openSetting(): Promise<void> {
    if (this.#editor || !this.#setting.open || !this.#model) return;
    const { desk, signal } = this.visit, { PresentationEditor } = await import("./presentation.ts");
    const poster = () => desk.api.blob(`${this.#path}/poster.png?width=240`, signal);
    const editor = (this.#editor = new PresentationEditor({ h, field, form, texts, gallery, language }, { drafts: drafts.presentation, stage: this.#stage, signal, poster, save: (changes) => this.#present(changes) }));
    this.#setting.append(editor.element);
    editor.show(this.#model);
  }

  /** Loads the editor of notes and tours when it is first opened. */
  async #openNotes(): Promise<void> {
    if (!this.#noting.open) return this.#notes?.rest();
    if (this.#notes || !this.#model) return;
    const alert = new Alert(), attempt = async () => {
      this.#noting.querySelector(":scope > .alert")?.remove(); // removes the error of an earlier attempt
      if (!(await alert.attempt(() => this.#loadNotes()))) this.#noting.append(alert.element);
    };
    await (this.#openingNotes ??= attempt().finally(() => (this.#openingNotes = undefined)));
  }

  async #loadNotes(): Promise<void> {
    const { desk: { api, say }, signal } = this.visit, model = () => this.#model as ModelRecord;
    const { NotesEditor } = await import("./notes.ts");
    const path = (part: NotePart) => `${this.#path}/${part}`;
    const editor = new NotesEditor({ h, field, form, texts, gallery, language }, {
      drafts: drafts.notes, id: this.id, title: model().title, scale: model, stage: this.#stage, signal, saved: () => say(words.saved),
      read: (part) => api.tagged(path(part), signal),
      save: async (part, documents, tag) => (await api.sendTagged("PUT", path(part), documents, tag)).tag,
    });
    await editor.open();
    this.#notes = editor;
    this.#noting.append(editor.element);
  }

  /** Saves the presentation, and shows it in a new viewer as visitors see it. The form of the metadata keeps its unsaved texts. */
  async #present(changes: Placed): Promise<ModelRecord> {
    await this.visit.desk.api.send("PATCH", this.#path, changes, this.#tag);
    const model = await this.#read();
    this.#sight(model);
    this.#metadata.show(model, ["unit"]);
    void this.#showLevels();
    this.visit.desk.say(words.saved);
    return model;
  }

  #sight(model: ModelRecord): void {
    this.#stage.querySelector(".sight")?.remove();
    this.#stage.prepend(sight(this.visit, model));
  }

  /** Shows a state of the model. `own` are the fields of its metadata that the operator has just stored. */
  #show(model: ModelRecord, own: readonly string[] = []): void {
    this.#editor?.show(model);
    this.#title.textContent = model.title || gallery.untitled;
    this.#state.replaceChildren(modelBadge(model));
    if (this.#shown !== model.state) this.#sight(model);
    this.#shown = model.state;
    this.#side.replaceChildren(...this.#actions(model));
    this.#showRepairs(model);
    this.#metadata.show(model, own);
  }

  #showRepairs({ repairs = [] }: ModelRecord): void {
    this.#repairs.hidden = repairs.length === 0;
    this.#repairs.replaceChildren(h("h2", {}, texts.jobs.repairs), repairList(repairs));
  }

  #actions(model: ModelRecord): Node[] {
    const alert = new Alert(), { api, say } = this.visit.desk, isPublic = model.state === "published";
    const turn = async () => {
      await this.#changed(api.send("POST", `${this.#path}/${isPublic ? "unpublish" : "publish"}`));
      say(isPublic ? words.isDraft : words.isPublic);
    };
    const remove = async () => {
      if (!(await isConfirmed(words.deleteQuestion(model.title || gallery.untitled), words.deleteExplanation, words.deleteNow))) return;
      await api.send("DELETE", this.#path, undefined, this.#tag);
      forgetDrafts(this.id);
      say(words.deleted);
      location.hash = "#/models";
    };
    return [
      h("div", { class: "actions" }, button(isPublic ? words.unpublish : words.publish, alert, turn, isPublic ? "" : "primary"), button(words.delete, alert, remove, "danger")),
      alert.element,
      facts([gallery.facts.detail, gallery.amount(count(model.faces), size(model.bytes))], [texts.created, date(model.created)],
        [words.page, isPublic ? h("a", { href: model.links.page }, model.links.page) : null],
        [gallery.iiif, isPublic ? h("a", { href: `/iiif/${this.id}/manifest.json` }, `/iiif/${this.id}/…`) : null]),
      isPublic ? copyable(gallery.embed, snippet(model, location.origin)) : "",
    ].filter((part): part is HTMLElement => part !== "");
  }

  /** Creates the form that replaces the model's file. The model keeps its URL and metadata. */
  #replacing(): HTMLElement {
    const { desk, signal } = this.visit, list = h("ul", { class: "cards" });
    const take = ([file]: File[]) => {
      if (!file) return;
      const made = () => void (signal.aborted || this.#again());
      list.replaceChildren(cardOf(desk, desk.uploads.add(file), () => ({ fields: [], submit: words.replaceNow, order: () => ({ replace: this.id }), made })));
    };
    return h("details", { class: "card" }, h("summary", {}, words.replace), h("p", { class: "quiet" }, words.replaceHint), dropZone(words.replaceDrop, take), list);
  }
}

export const modelPage: ConsolePage = (visit) => new ModelEditor(visit, visit.words[0] as string).open();
