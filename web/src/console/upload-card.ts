// SPDX-License-Identifier: Apache-2.0
// One file from the operator's hand to a model: while it is on its way, its details are filled in.
import { h } from "../gallery/dom.ts";
import { size } from "../gallery/texts/index.ts";
import type { Desk } from "./desk.ts";
import { Alert, button, field, form, type Values } from "./forms.ts";
import { Bar } from "./parts.ts";
import { JobCard } from "./jobs.ts";
import { texts } from "./texts/index.ts";
import type { Sending } from "./uploads.ts";

const words = texts.uploads;
export const kUnits: [string, string][] = [["", words.unitOfFile], ["mm", "mm"], ["cm", "cm"], ["m", "m"], ["in", "in"]];

/** `order` is sent once the file is whole; with `fields` the operator completes it. */
export interface Making {
  fields: HTMLElement[];
  submit: string;
  order: (values: Values) => Record<string, unknown>;
  made?: () => void;
}

/** They go on behind other pages, and are found as they were left. */
const cards = new WeakMap<Sending, HTMLElement>();
const never = new AbortController().signal;

export function cardOf(desk: Desk, sending: Sending, making: () => Making): HTMLElement {
  const card = cards.get(sending) ?? uploadCard(desk, sending, making());
  cards.set(sending, card);
  return card;
}

function uploadCard(desk: Desk, sending: Sending, { fields, submit, order, made }: Making): HTMLElement {
  const bar = new Bar(words.progress(sending.file.name)), line = h("p", { class: "quiet" }), alert = new Alert();
  const actions = h("div", { class: "actions" }), job = new JobCard(desk), card = h("li", { class: "card upload" });
  const give = async () => {
    await sending.cancel();
    desk.uploads.remove(sending);
    card.remove();
  };
  const tell = () => {
    bar.value = sending.file.size ? sending.sent / sending.file.size : 0;
    line.textContent = `${words.states[sending.state]} · ${words.sent(size(sending.sent), size(sending.file.size))}`;
    if (sending.error) alert.show(sending.error);
    const { state } = sending;
    if (actions.dataset["state"] === state) return;
    actions.dataset["state"] = state;
    const again = async () => {
      alert.clear();
      sending.resume();
    };
    actions.replaceChildren(
      ...(state === "sending" ? [button(words.pause, alert, () => sending.pause())] : []),
      ...(state === "paused" || state === "failed" ? [button(words.resume, alert, again)] : []),
      ...(state === "whole" ? [] : [button(words.giveUp, alert, give)]));
  };
  sending.onChange = tell;

  const make = async (values: Values) => {
    entry.inert = true;
    line.textContent = words.afterwards;
    const upload = await sending.whole;
    try {
      const begun = await desk.api.begin<{ job: string }>("/models", { upload, ...order(values) });
      card.replaceChildren(h("h2", {}, sending.file.name), job.element);
      job.element.classList.remove("card");
      desk.uploads.remove(sending);
      await desk.jobs.watch(begun.job, (now) => {
        job.show(now);
        if (now.state === "done") made?.();
      }, never);
    } finally {
      entry.inert = false;
    }
  };
  const entry = form(fields, submit, make);
  card.append(h("h2", {}, sending.file.name), bar.element, line, actions, alert.element, entry);
  tell();
  return card;
}

/** Where files are dropped; a button beside it for those who do not drag. */
export function dropZone(label: string, take: (files: File[]) => void): HTMLElement {
  const input = h("input", { type: "file", multiple: true, accept: ".ply,.obj,.stl,.off,.glb,.pmesh", class: "hidden", tabindex: -1, "aria-label": label });
  const choose = h("button", { type: "button", onclick: () => input.click() }, words.choose);
  const zone = h("div", { class: "drop" }, h("p", {}, label), choose, h("small", {}, words.formats), input);
  input.addEventListener("change", () => {
    take([...(input.files ?? [])]);
    input.value = ""; // the same file may be chosen again
  });
  const over = (event: Event) => (event.preventDefault(), zone.classList.add("over"));
  zone.addEventListener("dragenter", over);
  zone.addEventListener("dragover", over);
  zone.addEventListener("dragleave", () => zone.classList.remove("over"));
  zone.addEventListener("drop", (event) => {
    event.preventDefault();
    zone.classList.remove("over");
    take([...(event.dataTransfer?.files ?? [])]);
  });
  return zone;
}

/** What came in part before this page was loaded. */
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

