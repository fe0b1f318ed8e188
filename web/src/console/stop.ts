// SPDX-License-Identifier: Apache-2.0
// The emergency stop: a button on every page that stops all scanners without confirmation.
import { h } from "../ui/dom.ts";
import type { Api } from "./api.ts";
import { pause } from "./desk.ts";
import { sentence } from "./forms.ts";
import { Problem } from "./problem.ts";
import { texts } from "./texts/index.ts";
import type { Scanner } from "./types.ts";

const kTries = 3;
/** Milliseconds between two attempts. */
const kBetween = 1000;
/** Interval in milliseconds at which the list of scanners is polled. */
const kPause = 3000;

export class EmergencyStop {
  readonly button = h("button", { type: "button", class: "stop", hidden: true }, texts.stop.button);
  readonly said = h("div", { role: "alert", class: "stopped", hidden: true });
  /**
   * Names of all scanners that have been in the list. If a scanner's daemon disappears from the list, its table may
   * still be turning.
   */
  readonly #scanners = new Set<string>();

  constructor(private readonly api: Pick<Api, "get" | "stop">) {
    this.button.addEventListener("click", () => void this.#stop());
  }

  /** Polls the list of scanners until `signal` is aborted, so that a stop need not wait for the list. */
  async keepLearning(signal: AbortSignal): Promise<void> {
    while (!signal.aborted) {
      // An error is ignored, because the next poll follows soon.
      await this.#learn(signal).catch(() => undefined);
      await pause(kPause, signal);
    }
  }

  async #learn(signal: AbortSignal): Promise<void> {
    const { scanners } = await this.api.get<{ scanners: Scanner[] }>("/scanners", signal);
    for (const { name } of scanners) this.#scanners.add(name);
    this.button.hidden = this.#scanners.size === 0;
  }

  async #stop(): Promise<void> {
    this.#say(texts.stop.stopping, "");
    const scanners = [...this.#scanners];
    const ends = await Promise.allSettled(scanners.map((name) => this.#surely(name)));
    const failed = ends.find((end): end is PromiseRejectedResult => end.status === "rejected");
    if (failed) this.#say(`${texts.stop.failed} ${sentence(failed.reason)}`, "bad");
    else this.#say(texts.stop.done(scanners.join(", ")), "good");
  }

  /** Sends the stop up to kTries times, until it succeeds. Does not retry after a 4xx response. */
  async #surely(scanner: string): Promise<void> {
    for (let left = kTries; ; --left) {
      try {
        return await this.api.stop(scanner);
      } catch (error) {
        const isRefused = error instanceof Problem && error.status < 500;
        if (left === 1 || isRefused) throw error;
        await new Promise((resolve) => setTimeout(resolve, kBetween));
      }
    }
  }

  #say(text: string, kind: string): void {
    const close = h("button", { type: "button", "aria-label": texts.close, onclick: () => (this.said.hidden = true) }, "×");
    this.said.className = `stopped ${kind}`;
    this.said.replaceChildren(h("p", {}, text), close);
    this.said.hidden = false;
  }
}
