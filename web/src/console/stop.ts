// SPDX-License-Identifier: Apache-2.0
// The emergency stop: a button on every page that stops all scanners without confirmation. The text
// of the banner below it is derived from the states of lasers and motors, so it never contradicts
// them.
import { h } from "../ui/dom.ts";
import type { Api } from "./api.ts";
import { sentence } from "./forms.ts";
import { Problem } from "./problem.ts";
import { isOff, isUnknown, type ScannerWatch } from "./scanner-watch.ts";
import { texts } from "./texts/index.ts";

const kTries = 3;
/** Milliseconds between two attempts to stop a scanner. */
const kBetween = 1000;

export class EmergencyStop {
  readonly button = h("button", { type: "button", class: "stop", hidden: true }, texts.stop.button);
  readonly said = h("div", { role: "alert", class: "stopped", hidden: true });
  /**
   * The phase of the newest stop: "sent" until all scanners have responded, then "over" until a laser or motor is on
   * again.
   */
  #phase: "none" | "sent" | "over" = "none";
  /** Why scanners did not confirm the stop; empty if all scanners did. */
  #fault = "";
  #shown = "";

  constructor(private readonly api: Pick<Api, "stop">, private readonly watch: ScannerWatch) {
    this.button.addEventListener("click", () => void this.#stop());
    watch.onChange = () => this.#show();
  }

  async #stop(): Promise<void> {
    this.#phase = "sent";
    this.#show();
    this.watch.outdate();
    const ends = await Promise.allSettled([...this.watch.scanners.keys()].map((name) => this.#surely(name)));
    const failed = ends.find((end): end is PromiseRejectedResult => end.status === "rejected");
    this.#fault = failed ? sentence(failed.reason) : "";
    this.#phase = "over";
    this.watch.outdate();
    this.#show();
  }

  /** Sends the stop up to kTries times, until one attempt succeeds. Does not retry after a 4xx response. */
  async #surely(name: string): Promise<void> {
    for (let left = kTries; ; --left) {
      try {
        return this.watch.set(name, await this.api.stop(name));
      } catch (error) {
        this.watch.set(name, null);
        const isRefused = error instanceof Problem && error.status < 500;
        if (left === 1 || isRefused) throw error;
        await new Promise((resolve) => setTimeout(resolve, kBetween));
      }
    }
  }

  #show(): void {
    const { scanners } = this.watch, states = [...scanners.values()];
    this.button.hidden = scanners.size === 0;
    if (this.#phase === "none") return this.#say("", "");
    if (this.#phase === "sent") return this.#say(texts.stop.stopping, "");
    if (states.every(isOff)) return this.#say(texts.stop.done([...scanners.keys()].join(", ")), "good");
    if (this.#fault || states.some(isUnknown)) return this.#say(`${texts.stop.failed} ${this.#fault}`.trim(), "bad");
    this.#close(); // a laser or a motor was switched on after the stop
  }

  #close(): void {
    this.#phase = "none";
    this.#fault = "";
    this.#say("", "");
  }

  /**
   * Shows the text, or hides the banner if the text is empty. An unchanged text is not announced
   * again.
   */
  #say(text: string, kind: string): void {
    if (text === this.#shown) return;
    this.#shown = text;
    const close = h("button", { type: "button", "aria-label": texts.close, onclick: () => this.#close() }, "×");
    this.said.className = `stopped ${kind}`;
    this.said.replaceChildren(h("p", {}, text), close);
    this.said.hidden = text === "";
  }
}
