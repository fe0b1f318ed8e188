// SPDX-License-Identifier: Apache-2.0
// Edits how a model is presented: upright, unit and scale, first view, poster and light. The viewer shows changes at once. They are
// kept while the operator visits other pages, until they are saved or discarded.
import type { Presentation, PresentedView } from "../core/presentation.ts";
import type { Presenter } from "../element/tools/presenter.ts";
import type { h as make } from "../ui/dom.ts";
import type { texts as ofGallery } from "../ui/texts/index.ts";
import type { field as makeField, form as makeForm } from "./forms.ts";
import { after, turn, viewAxes, type Vector } from "./rotation.ts";
import { Ruler } from "./ruler.ts";
import type { texts as ofConsole } from "./texts/index.ts";
import { turner } from "./turner.ts";
import type { ModelRecord, Unit } from "./types.ts";

/** Functions and texts of the console. This file is loaded when it is first used, and shares no code with the console's other files. */
export interface Kit {
  h: typeof make;
  field: typeof makeField;
  form: typeof makeForm;
  texts: typeof ofConsole;
  gallery: typeof ofGallery;
  language: string;
}

/** The values that the editor changes. */
export type Placed = { unit: Unit | ""; presentation: Presentation };

export interface EditorOptions {
  /** Unsaved changes by the model's ID. */
  drafts: Map<string, Placed>;
  /** The element that contains the viewer. */
  stage: HTMLElement;
  signal: AbortSignal;
  /** Stores the changes, shows the model in a new viewer and returns its new record. Rejects if the daemon refuses the changes. */
  save(changes: Placed): Promise<ModelRecord>;
  /** Returns the present poster. */
  poster(): Promise<Blob>;
}

const kAxes: Record<"x" | "y" | "z", Vector> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const kPlain: Presentation = { rotation: [0, 0, 0, 1], scale: 1, view: null, poster: null, light: null };

export class PresentationEditor {
  readonly element: HTMLElement;
  readonly #ruler: Ruler;
  readonly #form: HTMLFormElement;
  readonly #size: HTMLElement;
  readonly #measured: HTMLElement;
  readonly #measure: HTMLButtonElement;
  readonly #known: HTMLElement;
  readonly #chosen: Record<"view" | "poster" | "light", HTMLElement>;
  readonly #poster: HTMLImageElement;
  readonly #discard: HTMLButtonElement;
  readonly #restored: HTMLElement;
  readonly #number: Intl.NumberFormat;
  #id = "";
  #saved: Placed = { unit: "", presentation: kPlain };
  #now = this.#saved;

  constructor(private readonly kit: Kit, private readonly options: EditorOptions) {
    const { stage, signal } = options, { h, field, form, texts, gallery } = kit, words = texts.presentation;
    this.#number = new Intl.NumberFormat(kit.language, { maximumSignificantDigits: 4 });
    this.#size = h("p", { class: "quiet", "aria-live": "polite" });
    this.#measured = h("p", { class: "quiet", "aria-live": "polite" });
    this.#measure = h("button", { type: "button", "aria-pressed": "false", onclick: () => (this.#ruler.isActive = !this.#ruler.isActive) }, words.measure);
    this.#chosen = { view: h("span"), poster: h("span"), light: h("span") };
    this.#poster = h("img", { class: "poster", alt: words.poster, width: 120, height: 120, hidden: true });
    this.#discard = h("button", { type: "button", onclick: () => this.#change(this.#saved) }, words.discard);
    this.#restored = h("p", { class: "quiet", role: "status", hidden: true }, words.restored);
    const handle = turner(h, words.handle, (about, degrees) => this.#turn(this.#viewAxis(about), degrees));
    const plumb = h("div", { class: "plumb" });
    stage.append(plumb, handle);
    signal.addEventListener("abort", () => [plumb, handle].forEach((part) => part.remove()));
    this.#ruler = new Ruler(h, stage, () => this.#presenter, signal);
    this.#ruler.onChange = () => this.#tell();
    // A new viewer shows the saved presentation at first, so the unsaved one is shown again.
    stage.addEventListener("load", () => this.#preview(), { signal, capture: true });
    const units: [string, string][] = [["", texts.model.unknownUnit], ...Object.entries(gallery.units)];
    const unit = field({ name: "unit", label: gallery.facts.unit, options: units });
    const scale = field({ name: "scale", label: words.scale, hint: words.scaleHint, type: "number", step: "any", min: 0 });
    this.#known = h("div", { class: "known" }, field({ name: "known", label: words.known, type: "number", step: "any", min: 0 }),
      h("button", { type: "button", onclick: () => this.#fit() }, words.fit));
    this.#form = form([this.#upright(), this.#group(words.size, h("div", { class: "pair" }, unit, scale), this.#size, h("div", { class: "actions" }, this.#measure), this.#measured, this.#known),
      this.#looks()], words.save, () => this.#save());
    this.#form.querySelector(".actions:has([type=submit])")?.append(this.#discard);
    this.#control("unit").addEventListener("change", () => this.#change({ ...this.#now, unit: this.#control("unit").value as Unit | "" }));
    this.#control("scale").addEventListener("input", () => this.#scaleTo(Number(this.#control("scale").value), false));
    this.element = h("div", { class: "presentation" }, this.#restored, this.#form);
  }

  /** Shows the values of a model in the editor. Continues with the unsaved changes of this model, if there are any. */
  show({ id, unit, presentation }: ModelRecord): void {
    this.#id = id;
    this.#saved = { unit, presentation };
    const draft = this.options.drafts.get(id);
    this.#restored.hidden = !draft;
    this.#change(draft ?? this.#saved);
    void this.#showPoster();
  }

  get #presenter(): Presenter | undefined {
    return this.options.stage.querySelector("progressive-mesh")?.presenter;
  }

  #control(name: string): HTMLInputElement {
    return this.#form.elements.namedItem(name) as HTMLInputElement;
  }

  #upright(): HTMLElement {
    const { h, texts: { presentation: words } } = this.kit;
    const step = (axis: "x" | "y" | "z", degrees: number) =>
      h("button", { type: "button", "aria-label": words.quarter(axis, degrees), onclick: () => this.#turn(kAxes[axis], degrees) }, degrees > 0 ? `${axis} ↺` : `${axis} ↻`);
    const steps = (["x", "y", "z"] as const).flatMap((axis) => [step(axis, 90), step(axis, -90)]);
    return this.#group(words.upright, h("p", { class: "quiet" }, words.uprightHint), h("div", { class: "quarters" }, ...steps));
  }

  #looks(): HTMLElement {
    const { h, texts: { presentation: words } } = this.kit;
    const row = (label: string, status: HTMLElement, take: string, act: () => void, clear: () => void, show?: () => void) =>
      h("div", { class: "look", role: "group", "aria-label": label }, h("b", {}, label), status,
        h("div", { class: "actions" }, h("button", { type: "button", onclick: act }, take), h("button", { type: "button", onclick: clear }, words.usual),
          show && h("button", { type: "button", class: "plain", onclick: show }, words.show)));
    const present = (part: Partial<Presentation>) => this.#change({ ...this.#now, presentation: { ...this.#now.presentation, ...part } });
    const moment = () => this.#presenter?.moment;
    const { view, poster, light } = this.#chosen, see = (seen: PresentedView | null) => this.#presenter?.show(seen);
    return this.#group(words.looks, h("p", { class: "quiet" }, words.looksHint),
      row(words.view, view, words.takeView, () => present({ view: moment()?.view ?? null }), () => present({ view: null }), () => see(this.#now.presentation.view)),
      row(words.poster, poster, words.takeView, () => present({ poster: moment()?.view ?? null }), () => present({ poster: null }),
        () => see(this.#now.presentation.poster ?? this.#now.presentation.view)),
      this.#poster,
      row(words.light, light, words.takeLight, () => present({ light: moment()?.light ?? null }), () => present({ light: null })));
  }

  #viewAxis(about: "right" | "up" | "eye"): Vector {
    return viewAxes(this.#presenter?.moment.view ?? { azimuth: 0, elevation: 0 })[about];
  }

  #turn(axis: Vector, degrees: number): void {
    const { presentation } = this.#now, centred = (view: PresentedView | null) => view && { ...view, target: null };
    this.#ruler.isActive = false;
    this.#change({ ...this.#now, presentation: {
      ...presentation, rotation: after(turn(axis, degrees), presentation.rotation), view: centred(presentation.view), poster: centred(presentation.poster),
    } });
  }

  #scaleTo(scale: number, writes = true): void {
    if (!(scale > 0)) return;
    const { presentation } = this.#now, ratio = scale / presentation.scale;
    const scaled = (view: PresentedView | null) => view && { ...view, target: view.target && (view.target.map((part) => part * ratio) as Vector) };
    this.#ruler.isActive = false;
    this.#change({ ...this.#now, presentation: { ...presentation, scale, view: scaled(presentation.view), poster: scaled(presentation.poster) } }, writes);
  }

  /** Scales the model so that the measured length becomes the known length. */
  #fit(): void {
    const known = Number(this.#control("known").value);
    if (known > 0 && this.#ruler.length > 0) this.#scaleTo(Number(((this.#now.presentation.scale * known) / this.#ruler.length).toPrecision(8)));
    else this.#control("known").focus();
  }

  /** Shows the values `now`. Leaves the scale's field unchanged if `writesScale` is false, because the operator is typing in it. */
  #change(now: Placed, writesScale = true): void {
    this.#now = now;
    const isSame = JSON.stringify(now) === JSON.stringify(this.#saved);
    if (isSame) this.options.drafts.delete(this.#id);
    else this.options.drafts.set(this.#id, now);
    if (isSame) this.#restored.hidden = true;
    this.#discard.disabled = isSame;
    (this.#form.querySelector("[type=submit]") as HTMLButtonElement).disabled = isSame;
    this.#control("unit").value = now.unit;
    if (writesScale) this.#control("scale").value = String(now.presentation.scale);
    this.#preview();
  }

  #preview(): void {
    this.#presenter?.preview(this.#now.presentation);
    this.#tell();
  }

  #tell(): void {
    const { unit, presentation: { view, poster, light } } = this.#now, size = this.#presenter?.size, number = this.#number;
    const words = this.kit.texts.presentation;
    const length = (value: number) => `${number.format(value)}${unit && ` ${unit}`}`;
    this.#size.textContent = size ? words.extent(size.map((side) => number.format(side)).join(" × "), unit) : "";
    this.#measure.ariaPressed = String(this.#ruler.isActive);
    this.#known.hidden = this.#ruler.points < 2;
    this.#measured.textContent = !this.#ruler.isActive ? "" : this.#ruler.points < 2 ? words.point(this.#ruler.points + 1) : words.measured(length(this.#ruler.length));
    const angles = (seen: PresentedView) => words.angles(number.format(Math.round(seen.azimuth)), number.format(Math.round(seen.elevation)), number.format(seen.zoom));
    this.#chosen.view.textContent = view ? angles(view) : words.usual;
    this.#chosen.poster.textContent = poster ? angles(poster) : words.asFirstView;
    this.#chosen.light.textContent = light ? words.lights[light.preset] : words.usual;
  }

  async #save(): Promise<void> {
    const model = await this.options.save(this.#now);
    this.options.drafts.delete(this.#id);
    this.show(model);
  }

  async #showPoster(): Promise<void> {
    const poster = await this.options.poster().catch(() => undefined);
    this.#poster.hidden = !poster;
    if (!poster) return;
    const url = URL.createObjectURL(poster);
    this.#poster.addEventListener("load", () => URL.revokeObjectURL(url), { once: true });
    this.#poster.src = url;
  }

  #group(title: string, ...parts: HTMLElement[]): HTMLElement {
    const { h } = this.kit;
    return h("fieldset", {}, h("legend", {}, title), ...parts);
  }
}
