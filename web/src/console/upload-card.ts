// SPDX-License-Identifier: Apache-2.0
// Cards for uploads. Each card has a form for the model that is made from the file. The operator
// fills in the form during the upload.
import { h } from "../ui/dom.ts";
import { size } from "../ui/texts/index.ts";
import type { Desk } from "./desk.ts";
import { Alert, button, field, form, type Values } from "./forms.ts";
import { Bar } from "./parts.ts";
import { JobCard } from "./jobs.ts";
import { texts } from "./texts/index.ts";
import { droppedFiles, uploadsOf, type Dropped } from "./dropped.ts";
import { kBesideTypes, kUploadNames, kUploadSuffixes } from "./mesh-formats.ts";
import type { Sending, SendingState } from "./uploads.ts";

const words = texts.uploads;
export const kUnits: [string, string][] = [["", words.unitOfFile], ["mm", "mm"], ["cm", "cm"], ["m", "m"], ["in", "in"]];

/**
 * The form of an upload. `order` converts the form's values to the request that is sent when the
 * upload is complete. `made` is called when the model exists.
 */
export interface Making {
  fields: HTMLElement[];
  submit: string;
  order: (values: Values) => Record<string, unknown>;
  made?: () => void;
}

/** The cards of all uploads. They are kept when the operator leaves the page, because the uploads continue. */
const cards = new WeakMap<Sending, HTMLElement>();
const never = new AbortController().signal;

export function cardOf(desk: Desk, sending: Sending, making: () => Making): HTMLElement {
  const card = cards.get(sending) ?? new UploadCard(desk, sending, making()).element;
  cards.set(sending, card);
  return card;
}

/** A card that shows an upload with its actions and form, and later the job that makes the model. */
class UploadCard {
  readonly element = h("li", { class: "card upload" });
  readonly #bar: Bar;
  readonly #line = h("p", { class: "quiet" });
  readonly #actions = h("div", { class: "actions" });
  readonly #alert = new Alert();
  readonly #job: JobCard;
  readonly #form: HTMLFormElement;

  constructor(private readonly desk: Desk, private readonly sending: Sending, private readonly making: Making) {
    this.#bar = new Bar(words.progress(sending.file.name));
    this.#job = new JobCard(desk, true);
    this.#form = form(making.fields, making.submit, (values) => this.#make(values));
    this.element.append(this.#heading, this.#bar.element, this.#line, this.#actions, this.#alert.element, this.#form);
    sending.onChange = () => this.#show();
    this.#show();
  }

  get #heading(): HTMLElement {
    return h("h2", {}, this.sending.file.name);
  }

  #show(): void {
    const { file, sent, state, error } = this.sending;
    this.#bar.value = file.size ? sent / file.size : 0;
    this.#line.textContent = `${words.states[state]} · ${words.sent(size(sent), size(file.size))}`;
    if (error) this.#alert.show(error);
    if (this.#actions.dataset["state"] === state) return;
    this.#actions.dataset["state"] = state;
    this.#actions.replaceChildren(...this.#choices(state));
  }

  #choices(state: SendingState): HTMLElement[] {
    return [
      ...(state === "sending" ? [button(words.pause, this.#alert, () => this.sending.pause())] : []),
      ...(state === "paused" || state === "failed" ? [button(words.resume, this.#alert, () => this.#resume())] : []),
      ...(state === "whole" ? [] : [button(words.giveUp, this.#alert, () => this.#discard())]),
    ];
  }

  async #resume(): Promise<void> {
    this.#alert.clear();
    this.sending.resume();
  }

  async #discard(): Promise<void> {
    await this.sending.cancel();
    this.desk.uploads.remove(this.sending);
    this.element.remove();
  }

  /** Waits until the file is uploaded, then starts the job and replaces the form by the job's progress. */
  async #make(values: Values): Promise<void> {
    this.#form.inert = true;
    this.#line.textContent = words.afterwards;
    const upload = await this.sending.whole;
    try {
      const { job } = await this.desk.api.begin<{ job: string }>("/models", { upload, ...this.making.order(values) });
      this.element.replaceChildren(this.#heading, this.#job.element);
      this.#job.element.classList.remove("card");
      this.desk.uploads.remove(this.sending);
      await this.desk.jobs.watch(job, (now) => {
        this.#job.show(now);
        if (now.state === "done") this.making.made?.();
      }, never);
    } finally {
      this.#form.inert = false;
    }
  }
}

/**
 * Creates an area onto which files and folders can be dropped, with a button that opens a file
 * dialog. Calls `take` with the files to upload: a model and its pictures are one file.
 */
export function dropZone(label: string, take: (files: File[]) => void): HTMLElement {
  const input = h("input", { type: "file", multiple: true, accept: [...kUploadSuffixes, ...kBesideTypes].join(), class: "hidden", tabindex: -1, "aria-label": label });
  const choose = h("button", { type: "button", onclick: () => input.click() }, words.choose);
  const zone = h("div", { class: "drop" }, h("p", {}, label), choose, h("small", {}, words.formats(kUploadNames)), h("small", {}, words.together), input);
  const chosen = (files: Dropped[]) => take(uploadsOf(files));
  input.addEventListener("change", () => {
    chosen([...(input.files ?? [])].map((file) => ({ path: file.name, file })));
    input.value = ""; // lets the operator choose the same file again
  });
  const over = (event: Event) => (event.preventDefault(), zone.classList.add("over"));
  zone.addEventListener("dragenter", over);
  zone.addEventListener("dragover", over);
  zone.addEventListener("dragleave", () => zone.classList.remove("over"));
  zone.addEventListener("drop", (event) => {
    event.preventDefault();
    zone.classList.remove("over");
    if (event.dataTransfer) void droppedFiles(event.dataTransfer).then(chosen);
  });
  return zone;
}

/** Creates cards for uploads that were interrupted before this page was loaded. */
export async function interruptedUploads(desk: Desk, say: (text: string) => void): Promise<HTMLElement[]> {
  const known = await desk.uploads.interrupted();
  return known.map((one) => {
    const row = h("li", { class: "card interrupted" });
    const alert = new Alert();
    const forget = async () => {
      await desk.uploads.forget(one);
      row.remove();
      say(words.forgotten);
    };
    row.dataset["name"] = one.metadata["filename"] ?? "";
    row.append(h("h2", {}, one.metadata["filename"] ?? ""), h("p", {}, words.interrupted(size(one.size ?? 0))),
      h("div", { class: "actions" }, button(words.forget, alert, forget)), alert.element);
    return row;
  });
}
