// SPDX-License-Identifier: Apache-2.0
// Interface elements that several pages share.
import { h } from "../ui/dom.ts";
import { count, timeLeft } from "../ui/texts/index.ts";
import { stageName, texts } from "./texts/index.ts";
import { isOver, type Job, type ModelRecord } from "./types.ts";

export class Bar {
  readonly element: HTMLElement;
  readonly #fill = h("div");

  constructor(label: string) {
    this.element = h("div", { class: "bar", role: "progressbar", "aria-label": label, "aria-valuemin": 0, "aria-valuemax": 100 }, this.#fill);
  }

  set value(share: number) {
    this.element.setAttribute("aria-valuenow", String(Math.round(100 * share)));
    this.#fill.style.transform = `scaleX(${share})`;
  }
}

export function badge(text: string, kind: string): HTMLElement {
  return h("span", { class: `badge ${kind}` }, text);
}

export function modelBadge({ state }: ModelRecord): HTMLElement {
  return badge(texts.models.states[state], state);
}

export function jobBadge({ state }: Job): HTMLElement {
  return badge(texts.jobs.states[state], state);
}

/** Describes a job: its stage, its remaining time, and the reason if it waits or has failed. */
export function jobLine(job: Job): string {
  const underWay = job.state === "running" && job.eta !== null ? timeLeft(job.eta) : "";
  const stage = !isOver(job) && job.stage ? stageName(job.stage) : "";
  return [stage, underWay, job.note, job.error].filter(Boolean).join(" · ");
}

export function heading(text: string, ...beside: (Node | null)[]): HTMLElement {
  return h("header", { class: "heading" }, h("h1", { tabindex: -1 }, text), ...beside);
}

/** Lists what a build changed or left out. */
export function repairList(repairs: readonly string[]): HTMLElement {
  return h("ul", { class: "repairs" }, ...repairs.map((line) => h("li", {}, line)));
}

export function facts(...pairs: [string, string | Node | null][]): HTMLElement {
  return h("dl", {}, ...pairs.flatMap(([name, value]) => (value === null || value === "" ? [] : [h("dt", {}, name), h("dd", {}, value)])));
}

export function table(caption: string, heads: string[], rows: (string | Node)[][]): HTMLElement {
  return h("div", { class: "table", tabindex: 0, role: "region", "aria-label": caption },
    h("table", {}, h("thead", {}, h("tr", {}, ...heads.map((text) => h("th", { scope: "col" }, text)))),
      h("tbody", {}, ...rows.map((cells) => h("tr", {}, ...cells.map((cell) => h("td", {}, cell)))))));
}

/**
 * Fills a list with its first page, and adds a button that appends the next page. `ask` returns the
 * rows of the page that starts at `cursor`, and the cursor of the following page. Resolves to the
 * number of rows on the first page.
 */
export async function paged(list: HTMLElement, ask: (cursor: string | null) => Promise<{ rows: Node[]; next: string | null }>): Promise<number> {
  const first = await ask(null);
  list.replaceChildren(...first.rows);
  let cursor = first.next;
  const more = h("button", { type: "button", class: "more" }, texts.more);
  more.hidden = cursor === null;
  more.addEventListener("click", async () => {
    more.disabled = true;
    const { rows, next } = await ask(cursor).finally(() => (more.disabled = false));
    list.append(...rows);
    cursor = next;
    more.hidden = cursor === null;
  });
  list.parentElement?.querySelector(":scope > .more")?.remove();
  list.after(more);
  return first.rows.length;
}

export const triangles = (faces: number): string => texts.models.triangles(count(faces));
