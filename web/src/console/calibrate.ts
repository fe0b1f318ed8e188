// SPDX-License-Identifier: Apache-2.0
// The page "#/scanners/{name}/calibrate": a wizard that guides the operator through a calibration.
import { h } from "../ui/dom.ts";
import { measure } from "../ui/texts/index.ts";
import type { ConsolePage, Visit } from "./desk.ts";
import { Alert, button, field, form, isConfirmed } from "./forms.ts";
import { Bar, facts, heading, jobLine } from "./parts.ts";
import { residuals } from "./scanner.ts";
import { texts } from "./texts/index.ts";
import { isOver, type Calibrations, type Job } from "./types.ts";

const words = texts.calibration;
const kPoses = 20;

class Wizard {
  readonly #step = h("section", { class: "card wizard" });
  readonly #path: string;
  // The job's state and stage that are shown. Elements are replaced only if these change, because
  // replacing an element with the focus would lose the focus.
  #shown = "";

  constructor(private readonly visit: Visit, private readonly name: string) {
    this.#path = `/scanners/${encodeURIComponent(name)}`;
  }

  async open(): Promise<string> {
    const { desk, view } = this.visit, title = words.of(this.name);
    view.append(heading(title), this.#step);
    await desk.jobs.refresh();
    const open = desk.jobs.all.find((job) => job.kind === "calibrate" && job.scanner === this.name && !isOver(job));
    if (open) await this.#follow(open.id); // a calibration that was started before this page was loaded
    else this.#prepare();
    return title;
  }

  #prepare(): void {
    const begin = async ({ poses }: { poses?: unknown }) => {
      const { job } = await this.visit.desk.api.begin<{ job: string }>(`${this.#path}/calibrations`, { poses });
      await this.#follow(job);
    };
    this.#step.replaceChildren(h("h2", {}, words.prepare), h("ol", {}, ...words.steps.map((text) => h("li", {}, text))),
      form([field({ name: "poses", label: words.poses, hint: words.posesHint, type: "number", min: 3, max: 200, value: kPoses, required: true })], words.start, begin));
  }

  async #follow(id: string): Promise<void> {
    const bar = new Bar(words.progress), line = h("p", { role: "status" }), turn = h("div"), alert = new Alert();
    const { desk, signal } = this.visit;
    const cancel = async () => {
      if (await isConfirmed(words.cancelQuestion, words.cancelExplanation, texts.jobs.cancel)) desk.jobs.put(await desk.api.send<Job>("DELETE", `/jobs/${id}`));
    };
    this.#step.replaceChildren(h("h2", {}, words.measuring), bar.element, line, turn, h("div", { class: "actions" }, button(texts.jobs.cancel, alert, cancel)), alert.element);
    await desk.jobs.watch(id, (job) => {
      bar.value = job.progress;
      const text = jobLine(job);
      if (line.textContent !== text) line.textContent = text;
      if (isOver(job)) void alert.attempt(() => this.#end(job));
      else this.#ask(job, turn);
    }, signal);
  }

  /** Asks the operator to place the target if the job is paused. Laser and motor are off during the pause. */
  #ask(job: Job, turn: HTMLElement): void {
    const shown = `${job.state} ${job.stage}`;
    if (shown === this.#shown) return;
    this.#shown = shown;
    if (job.state !== "paused") return turn.replaceChildren();
    const alert = new Alert(), { api, jobs } = this.visit.desk;
    const placed = button(words.placed, alert, async () => jobs.put(await api.send<Job>("POST", `/jobs/${job.id}/resume`, {})), "primary");
    turn.replaceChildren(h("div", { class: "prompt" }, h("p", {}, words.placeHint), placed, alert.element));
    placed.focus();
  }

  async #end(job: Job): Promise<void> {
    if (job.state === this.#shown) return;
    this.#shown = job.state;
    const again = h("button", { type: "button", onclick: () => this.#prepare() }, words.again);
    if (job.state !== "done") {
      const why = h("p", { class: "alert", role: "alert" }, job.error ?? texts.jobs.states[job.state]);
      return this.#step.replaceChildren(h("h2", {}, words.notDone), why, h("div", { class: "actions" }, again));
    }
    const { calibrations } = await this.visit.desk.api.get<Calibrations>(`${this.#path}/calibrations`, this.visit.signal), [made] = calibrations;
    if (!made) return this.#prepare();
    const accept = h("a", { class: "button primary", href: `#/scanners/${this.name}` }, words.accept);
    this.#step.replaceChildren(h("h2", { tabindex: -1 }, words.done(made.number)),
      facts(["rms", `${measure(made.rms)} mm`], ["p95", `${measure(made.p95)} mm`], ["max", `${measure(made.max)} mm`], [words.coverage, `${measure(100 * made.coverage)} %`]),
      residuals(this.visit, this.#path, made.number), h("p", { class: "quiet" }, words.acceptHint), h("div", { class: "actions" }, accept, again));
    accept.focus();
  }
}

export const calibratePage: ConsolePage = (visit) => new Wizard(visit, visit.words[0] as string).open();
