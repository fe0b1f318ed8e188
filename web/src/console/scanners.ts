// SPDX-License-Identifier: Apache-2.0
// The page "#/scanners": all scanners with their states.
import { h } from "../ui/dom.ts";
import { pause, type ConsolePage } from "./desk.ts";
import { badge, facts, heading } from "./parts.ts";
import { texts } from "./texts/index.ts";
import type { Scanner } from "./types.ts";

const words = texts.scanners;
/** Polling interval in milliseconds. */
const kPause = 3000;

export function scannerBadge({ state }: Scanner): HTMLElement {
  return badge(words.states[state], state);
}

export function scannerFacts({ camera, board, calibration }: Scanner): HTMLElement {
  return facts(
    [words.camera, camera && [camera.vendor, camera.model, camera.serial].filter(Boolean).join(" ")],
    [words.board, board && [board.dialect, board.firmware].filter(Boolean).join(" · ")],
    [words.calibration, calibration === null ? words.uncalibrated : texts.calibration.number(calibration)]);
}

export function scannerProblem({ problem }: Scanner): HTMLElement | null {
  return problem ? h("p", { class: "alert" }, problem) : null;
}

function card(scanner: Scanner): HTMLElement {
  return h("li", {}, h("a", { class: "card scanner", href: `#/scanners/${scanner.name}` },
    h("p", { class: "row" }, h("strong", {}, scanner.name), scannerBadge(scanner)), scannerFacts(scanner), scannerProblem(scanner)));
}

export const scannersPage: ConsolePage = async ({ desk, view, signal }) => {
  const list = h("ul", { class: "cards" });
  const fill = async () => {
    const { scanners } = await desk.api.get<{ scanners: Scanner[] }>("/scanners", signal);
    const cards = scanners.map(card);
    if (!isSame(cards, list)) list.replaceChildren(...cards);
    return scanners.length;
  };
  view.append(heading(words.title), list);
  if ((await fill()) === 0) view.append(h("p", { class: "quiet" }, words.none));
  void (async () => {
    for (;;) {
      await pause(kPause, signal);
      // Ignores an error, because the next poll follows soon.
      await fill().catch(() => undefined);
    }
  })().catch(() => undefined);
  return words.title;
};

/** Whether the list already shows these cards. Replacing equal cards would make a focused card lose the focus. */
function isSame(cards: HTMLElement[], list: HTMLElement): boolean {
  return cards.length === list.children.length && cards.every((one, i) => one.isEqualNode(list.children[i] as Node));
}
