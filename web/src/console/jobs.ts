// SPDX-License-Identifier: Apache-2.0
// The page "#/jobs": the daemon's jobs, updated live.
import { h } from "../ui/dom.ts";
import { time } from "../ui/texts/index.ts";
import type { ConsolePage } from "./desk.ts";
import type { Desk } from "./desk.ts";
import { Alert, button, isConfirmed } from "./forms.ts";
import { Bar, heading, jobBadge, jobLine, repairList } from "./parts.ts";
import { texts } from "./texts/index.ts";
import { isOver, type Job } from "./types.ts";

const words = texts.jobs;

/**
 * A card with a job's state and actions. Call `show` with each new state of the job. If
 * `opensRepairs` is true, the list of repairs is open when it appears.
 */
export class JobCard {
  readonly element = h("li", { class: "card job" });
  readonly #bar = new Bar(words.progress);
  readonly #line = h("p", { class: "quiet" });
  readonly #top = h("p", { class: "row" });
  readonly #repairs = h("details", { class: "quiet", hidden: true });
  readonly #actions = h("div", { class: "actions" });
  readonly #alert = new Alert();
  #state = "";

  constructor(private readonly desk: Desk, private readonly opensRepairs = false) {
    this.element.append(this.#top, this.#bar.element, this.#line, this.#repairs, this.#actions, this.#alert.element);
  }

  show(job: Job): void {
    this.#bar.value = job.progress;
    this.#bar.element.hidden = isOver(job);
    this.#line.textContent = jobLine(job);
    // Replaces the buttons only if `state` changes, because replacing a button with the focus would
    // lose the focus.
    const state = `${job.state} ${job.model} ${job.repairs.length}`;
    if (state === this.#state) return;
    this.#state = state;
    this.#showRepairs(job);
    this.#top.replaceChildren(h("strong", {}, words.kinds[job.kind]), jobBadge(job), h("span", { class: "quiet" }, [job.scanner, time(job.created)].filter(Boolean).join(" · ")));
    this.#actions.replaceChildren(...this.#choices(job));
  }

  #showRepairs({ repairs }: Job): void {
    // Opens the list only when it appears, so that it stays closed once the operator has closed it.
    if (this.#repairs.hidden && this.opensRepairs) this.#repairs.toggleAttribute("open", true);
    this.#repairs.hidden = repairs.length === 0;
    this.#repairs.replaceChildren(h("summary", {}, words.repairs), repairList(repairs));
  }

  #choices(job: Job): HTMLElement[] {
    const after = (act: () => Promise<Job>) => async () => this.desk.jobs.put(await act());
    const { api } = this.desk;
    const resume = after(() => api.send<Job>("POST", `/jobs/${job.id}/resume`, {}));
    const cancel = async () => {
      if (await isConfirmed(words.cancelQuestion, words.cancelExplanation, words.cancel)) await after(() => api.send<Job>("DELETE", `/jobs/${job.id}`))();
    };
    return [
      ...(job.state === "paused" || job.state === "failed" ? [button(words.resume, this.#alert, resume)] : []),
      ...(isOver(job) ? [] : [button(words.cancel, this.#alert, cancel)]),
      ...(job.model ? [h("a", { href: `#/models/${job.model}` }, words.model)] : []),
      ...(job.scan ? [h("a", { href: `#/scans/${job.scan}` }, words.scan)] : []),
    ];
  }
}

export const jobsPage: ConsolePage = ({ desk, view, signal }) => {
  const list = h("ul", { class: "cards" }), cards = new Map<string, JobCard>(), empty = h("p", { class: "quiet" }, words.empty);
  view.append(heading(words.title), list, empty);
  desk.jobs.onChange(() => {
    const { all } = desk.jobs;
    empty.hidden = all.length > 0;
    for (const job of all) {
      const card = cards.get(job.id) ?? new JobCard(desk);
      cards.set(job.id, card);
      card.show(job);
    }
    const order = all.map(({ id }) => (cards.get(id) as JobCard).element);
    if (order.some((element, i) => list.children[i] !== element)) list.replaceChildren(...order);
  }, signal);
  return words.title;
};
