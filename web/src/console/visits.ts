// SPDX-License-Identifier: Apache-2.0
// The page "#/visits": how often and how long each model was visited over some days, also as CSV.
import { h } from "../ui/dom.ts";
import { count, texts as gallery } from "../ui/texts/index.ts";
import type { ConsolePage } from "./desk.ts";
import { Alert, button, field, form } from "./forms.ts";
import { heading, table } from "./parts.ts";
import { texts } from "./texts/index.ts";
import type { Visits } from "./types.ts";

const words = texts.visits;

/** Writes a time as "3 h 20 min", "20 min" or "45 s". */
export function spent(seconds: number): string {
  const hours = Math.floor(seconds / 3600), minutes = Math.floor((seconds % 3600) / 60);
  if (hours > 0) return `${count(hours)} h ${minutes} min`;
  return minutes > 0 ? `${minutes} min` : `${seconds} s`;
}

/**
 * Formats the share of `part` in `whole` as a percentage, at most 100 %. The limit is needed
 * because a visit over midnight may be complete on a day on which it did not begin.
 */
export function percentage(part: number, whole: number): string {
  return whole > 0 ? `${Math.min(Math.round((100 * part) / whole), 100)} %` : "";
}

function row(name: Node | string, { visits, seconds, mean_level: level, complete }: Omit<Visits["models"][number], "model" | "title">): (Node | string)[] {
  return [name, count(visits), spent(seconds), visits > 0 ? spent(Math.round(seconds / visits)) : "", level.toFixed(1), percentage(complete, visits)];
}

/** Returns the rows of the table: first the sums over all models, then one row for each model. */
function rows({ models }: Visits): (Node | string)[][] {
  const sum = (of: (model: Visits["models"][number]) => number) => models.reduce((all, model) => all + of(model), 0);
  const visits = sum((model) => model.visits);
  const total = { visits, seconds: sum((model) => model.seconds), complete: sum((model) => model.complete),
    mean_level: visits > 0 ? sum((model) => model.visits * model.mean_level) / visits : 0 };
  return [row(h("strong", {}, words.all), total), ...models.map((model) => row(h("a", { href: `#/models/${model.model}` }, model.title || gallery.untitled), model))];
}

/** Lets the browser save a file. A link cannot do this, because it cannot send the token. */
function keep(content: Blob, name: string): void {
  const address = URL.createObjectURL(content);
  h("a", { href: address, download: name }).click();
  URL.revokeObjectURL(address);
}

export const visitsPage: ConsolePage = async ({ desk, view, signal }) => {
  const report = h("section", { class: "card visits", "aria-live": "polite" }), alert = new Alert();
  let days = "";
  const show = async (query: string) => {
    const found = await desk.api.get<Visits>(`/visits${query}`, signal);
    days = `?from=${found.from}&to=${found.to}`;
    const heads = [words.model, words.visits, words.time, words.mean, words.level, words.complete];
    report.replaceChildren(
      found.counted ? "" : h("p", {}, words.off),
      found.models.length ? table(words.title, heads, rows(found)) : h("p", { class: "quiet" }, words.empty));
    return found;
  };
  const { from, to } = await show("");
  const csv = button(words.csv, alert, async () => keep(await desk.api.blob(`/visits.csv${days}`, signal), `visits${days.replace(/[^0-9-]+/g, "-")}.csv`));
  view.append(heading(words.title),
    form([field({ name: "from", label: words.from, type: "date", value: from, required: true }), field({ name: "to", label: words.to, type: "date", value: to, required: true })],
      words.show, (chosen) => show(`?from=${chosen["from"]}&to=${chosen["to"]}`), "days"),
    report, h("p", { class: "quiet" }, words.privacy), h("div", { class: "actions" }, csv), alert.element);
  return words.title;
};
