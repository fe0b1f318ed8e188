// SPDX-License-Identifier: Apache-2.0
// The emergency stop: on every page, for every scanner, without a question.
import { h } from "../gallery/dom.ts";
import type { Api } from "./api.ts";
import { pause } from "./desk.ts";
import { sentence } from "./forms.ts";
import { texts } from "./texts/index.ts";
import type { Scanner } from "./types.ts";

const kTries = 3;
/** Milliseconds until the scanners are asked for again. */
const kPause = 2000;

export class EmergencyStop {
  readonly button = h("button", { type: "button", class: "stop", hidden: true }, texts.stop.button);
  readonly said = h("div", { role: "alert", class: "stopped", hidden: true });
  #scanners: string[] = [];

  constructor(private readonly api: Api) {
    this.button.addEventListener("click", () => void this.#stop());
  }

  /** Known before it is needed: nobody who presses waits for a list. */
  async learn(signal: AbortSignal): Promise<void> {
    for (;;) {
      try {
        const { scanners } = await this.api.get<{ scanners: Scanner[] }>("/scanners", signal);
        this.#scanners = scanners.map(({ name }) => name);
        this.button.hidden = scanners.length === 0;
        return;
      } catch {
        await pause(kPause, signal);
      }
    }
  }

  async #stop(): Promise<void> {
    this.#say(texts.stop.stopping, "");
    const ends = await Promise.allSettled(this.#scanners.map((name) => this.#surely(name)));
    const failed = ends.find((end): end is PromiseRejectedResult => end.status === "rejected");
    if (failed) this.#say(`${texts.stop.failed} ${sentence(failed.reason)}`, "bad");
    else this.#say(texts.stop.done(this.#scanners.join(", ")), "good");
  }

  async #surely(scanner: string): Promise<void> {
    for (let left = kTries; ; --left) {
      try {
        return await this.api.stop(scanner);
      } catch (error) {
        if (left === 1 || !(error instanceof TypeError)) throw error; // nobody answered: at once again
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
