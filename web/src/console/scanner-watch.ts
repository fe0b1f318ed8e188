// SPDX-License-Identifier: Apache-2.0
// Polls the state of each scanner's laser and motor and shows it in the header of every page.
import { h } from "../ui/dom.ts";
import { clock } from "../ui/texts/index.ts";
import type { Api } from "./api.ts";
import { pause } from "./desk.ts";
import { texts } from "./texts/index.ts";
import type { LaserState, MotorState, Scanner } from "./types.ts";

/** Milliseconds between two polls of the list of scanners. */
const kPause = 1000;

export interface Power {
  laser: LaserState;
  motor: MotorState;
  /** Time since which the laser has been in its state, or null if that is not known. */
  since: string | null;
}

const kUnknown: Power = { laser: "unknown", motor: "unknown", since: null };

/** Whether laser and motor are known to be off. */
export const isOff = ({ laser, motor }: Power): boolean => laser === "off" && motor === "off";
export const isUnknown = ({ laser, motor }: Power): boolean => laser === "unknown" || motor === "unknown";

// The state is missing in the response of a daemon of an earlier version.
const powerOf = ({ laser, motor }: Scanner): Power =>
  laser && motor ? { laser: laser.state, motor: motor.state, since: laser.since } : kUnknown;

export class ScannerWatch {
  readonly element = h("ul", { class: "power", "aria-label": texts.power.title, hidden: true });
  /**
   * All scanners that have ever been in the list. Even if a scanner disappears from the list because
   * its daemon fails, its table may still be turning.
   */
  readonly scanners = new Map<string, Power>();
  /** Called after each change. */
  onChange: () => void = () => undefined;
  #round = 0; // number of the current round; responses to polls of earlier rounds are ignored

  constructor(private readonly api: Pick<Api, "get">) {}

  /** Polls the list of scanners until `signal` is aborted. */
  async run(signal: AbortSignal): Promise<void> {
    while (!signal.aborted) {
      const round = this.#round;
      try {
        const { scanners } = await this.api.get<{ scanners: Scanner[] }>("/scanners", signal);
        if (round === this.#round) this.#learn(scanners);
      } catch {
        if (round === this.#round && !signal.aborted) this.#learn([]);
      }
      await pause(kPause, signal);
    }
  }

  /** Ignores the response to a poll in progress. Call this when a state is about to change. */
  outdate(): void {
    ++this.#round;
  }

  /** Sets the state that the daemon has reported for one scanner. Null means that it has not responded. */
  set(name: string, scanner: Scanner | null): void {
    this.scanners.set(name, scanner ? powerOf(scanner) : kUnknown);
    this.#show();
  }

  #learn(listed: Scanner[]): void {
    for (const name of this.scanners.keys()) this.scanners.set(name, kUnknown);
    for (const scanner of listed) this.scanners.set(scanner.name, powerOf(scanner));
    this.#show();
  }

  #show(): void {
    this.element.hidden = this.scanners.size === 0;
    this.element.replaceChildren(...[...this.scanners].map(([name, power]) =>
      h("li", { class: isOff(power) ? "off" : "" }, h("strong", {}, name), ` ${describe(power)}`)));
    this.onChange();
  }
}

function describe({ laser, motor, since }: Power): string {
  const words = texts.power;
  const lit = laser === "on" && since ? words.onSince(clock(since)) : words.laser[laser];
  return `${lit} · ${words.motor[motor]}`;
}
