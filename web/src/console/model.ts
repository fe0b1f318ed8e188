// SPDX-License-Identifier: Apache-2.0
// The page "#/models/{id}" of a model: viewer, metadata, visibility and build report.
import { snippet } from "../ui/about.ts";
import { copyable } from "../ui/copy.ts";
import { h } from "../ui/dom.ts";
import { count, date, size, texts as gallery } from "../ui/texts/index.ts";
import type { ConsolePage, Visit } from "./desk.ts";
import { Alert, button, field, form, isConfirmed, type Values } from "./forms.ts";
import { levelReport } from "./levels.ts";
import { facts, heading, modelBadge } from "./parts.ts";
import { texts } from "./texts/index.ts";
import type { Manifest, ModelRecord } from "./types.ts";
import { cardOf, dropZone } from "./upload-card.ts";

const words = texts.model;
const kTexts = ["title", "creator", "rights", "licence", "description", "date", "subject", "identifier", "publisher", "source"] as const;

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
  readonly #form = h("section", { class: "card" });
  readonly #title = h("h1", { tabindex: -1 });
  readonly #state = h("span");
  #tag = "";
  #shown = ""; // state of the model when the viewer was created

  constructor(private readonly visit: Visit, private readonly id: string) {
    this.#path = `/models/${id}`;
  }

  async open(): Promise<string> {
    const { view } = this.visit, model = await this.#read();
    view.append(h("header", { class: "heading" }, this.#title, this.#state),
      h("div", { class: "columns wide" }, h("div", {}, this.#stage, this.#report, this.#replacing()), h("div", {}, this.#side, this.#form)));
    this.#show(model);
    void this.#showLevels();
    return model.title || gallery.untitled;
  }

  async #read(): Promise<ModelRecord> {
    const { value, tag } = await this.visit.desk.api.tagged<ModelRecord>(this.#path, this.visit.signal);
    this.#tag = tag;
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

  /** Makes the viewer show the new file after the model's file was replaced. */
  async #again(): Promise<void> {
    this.#shown = "";
    this.#show(await this.#read());
    await this.#showLevels();
  }

  #show(model: ModelRecord): void {
    this.#title.textContent = model.title || gallery.untitled;
    this.#state.replaceChildren(modelBadge(model));
    if (this.#shown !== model.state) this.#stage.replaceChildren(sight(this.visit, model));
    this.#shown = model.state;
    this.#side.replaceChildren(...this.#actions(model));
    this.#form.replaceChildren(h("h2", {}, words.metadata), this.#details(model));
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

  #details(model: ModelRecord): HTMLElement {
    const text = (name: (typeof kTexts)[number]) => field({
      name, value: model[name], label: name === "title" ? gallery.title : name === "description" ? words.description : gallery.facts[name],
      ...(name === "description" || name === "rights" ? { type: "textarea" as const } : {}), ...(name === "licence" ? { hint: texts.models.licenceHint } : {}),
    });
    const units: [string, string][] = [["", words.unknownUnit], ...Object.entries(gallery.units)];
    const save = async (values: Values) => {
      await this.#changed(this.visit.desk.api.send("PATCH", this.#path, values, this.#tag));
      this.visit.desk.say(words.saved);
    };
    return form([...kTexts.map(text), field({ name: "unit", label: gallery.facts.unit, options: units, value: model.unit }),
      field({ name: "accuracy", label: gallery.facts.accuracy, hint: words.accuracyHint, type: "number", step: "any", min: 0, value: model.accuracy }),
      field({ name: "public_max_level", label: words.publicLevel, hint: words.publicLevelHint, type: "number", min: 0, max: 255, value: model.public_max_level })],
    words.save, save);
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
