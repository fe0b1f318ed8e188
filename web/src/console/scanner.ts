// SPDX-License-Identifier: Apache-2.0
// The page "#/scanners/{name}": camera preview, manual control of turntable and laser, calibrations.
import { h } from "../ui/dom.ts";
import { date, measure } from "../ui/texts/index.ts";
import { pause, type ConsolePage, type Visit } from "./desk.ts";
import { Alert, button, field, form, sentence } from "./forms.ts";
import { heading, table } from "./parts.ts";
import { picture, show } from "./pictures.ts";
import { scannerBadge, scannerFacts, scannerProblem } from "./scanners.ts";
import { texts } from "./texts/index.ts";
import type { Calibrations, Scanner } from "./types.ts";

const words = texts.scanner;
/**
 * Milliseconds: kPause between two preview pictures, kRetry after a picture could not be fetched,
 * and kLook between two polls of the scanner's state.
 */
const kPause = 200, kRetry = 2000, kLook = 2000;
const kJogs = [-90, -10, 10, 90];

/** Creates the camera preview. The preview fetches pictures while its checkbox "live" is checked. */
function preview({ desk, signal }: Visit, path: string): HTMLElement {
  const image = h("img", { alt: words.previewOf, class: "pending" }), note = h("p", { class: "quiet", role: "status" });
  const live = h("input", { type: "checkbox", id: "live" });
  let isRunning = false;
  const look = async () => {
    while (live.checked && !signal.aborted) {
      try {
        await show(image, await desk.api.blob(`${path}/preview`, signal));
        image.classList.remove("pending");
        note.textContent = "";
        await pause(kPause, signal);
      } catch (error) {
        note.textContent = sentence(error);
        await pause(kRetry, signal).catch(() => undefined);
      }
    }
  };
  live.addEventListener("change", async () => {
    if (isRunning) return;
    isRunning = true;
    await look();
    isRunning = false;
  });
  return h("section", { class: "preview" }, h("div", { class: "frame" }, image),
    h("div", { class: "row" }, h("label", { class: "switch", for: "live" }, live, words.live), note));
}

function byHand({ desk, signal }: Visit, name: string, path: string): HTMLElement {
  const alert = new Alert(), { api } = desk;
  let isLit = false; // whether this page has switched the laser on
  const putOut = () => {
    if (isLit) api.putOut(name);
    isLit = false;
  };
  const turn = (degrees: number) => api.send("POST", `${path}/jog`, { degrees });
  const laser = (on: boolean) => async () => {
    isLit ||= on;
    await api.send("POST", `${path}/laser`, { on });
    isLit = on;
    desk.say(on ? words.laserIsOn : words.laserIsOff);
  };
  signal.addEventListener("abort", putOut);
  addEventListener("pagehide", putOut, { signal });
  const jogs = kJogs.map((degrees) => button(`${degrees > 0 ? "+" : "−"}${Math.abs(degrees)}°`, alert, () => turn(degrees)));
  return h("section", { class: "card" }, h("h2", {}, words.byHand),
    h("h3", {}, words.table), h("div", { class: "actions" }, ...jogs),
    form([field({ name: "degrees", label: words.degrees, type: "number", min: -36000, max: 36000, step: "any", value: 45, required: true })], words.turn, ({ degrees }) => turn(Number(degrees)), "inline"),
    h("h3", {}, words.laser), h("div", { class: "actions" }, button(words.laserOn, alert, laser(true)), button(words.laserOff, alert, laser(false))),
    alert.element);
}

/**
 * Returns elements that show the residuals of the newest calibration and a table with the errors of all calibrations.
 */
export async function calibrationsOf({ desk, signal }: Visit, path: string): Promise<Node[]> {
  const { calibrations, damaged } = await desk.api.get<Calibrations>(`${path}/calibrations`, signal), { calibration } = texts;
  const rows = calibrations.map(({ number, created, rms, p95, max, coverage }) =>
    [String(number), date(created), measure(rms), measure(p95), measure(max), `${measure(100 * coverage)} %`]);
  const [newest] = calibrations;
  return [
    ...(newest ? [residuals({ desk, signal }, path, newest.number), table(calibration.title, [calibration.no, texts.created, "rms (mm)", "p95 (mm)", "max (mm)", calibration.coverage], rows)]
      : [h("p", { class: "quiet" }, calibration.none)]),
    ...damaged.map(({ number, problem }) => h("p", { class: "alert" }, `${calibration.number(number)}: ${problem}`)),
  ];
}

export function residuals({ desk, signal }: Pick<Visit, "desk" | "signal">, path: string, number: number): HTMLElement {
  const image = picture(desk.api, `${path}/calibrations/${number}/residuals.svg`, texts.calibration.plotOf(number), signal);
  return h("figure", { class: "plot" }, image, h("figcaption", { class: "quiet" }, texts.calibration.plotHint));
}

export const scannerPage: ConsolePage = async (visit) => {
  const { desk, view, signal, words: [name = ""] } = visit, path = `/scanners/${encodeURIComponent(name)}`;
  const state = h("div", { class: "state" }), badge = h("span");
  const look = async () => {
    const scanner = await desk.api.get<Scanner>(path, signal);
    badge.replaceChildren(scannerBadge(scanner));
    state.replaceChildren(scannerFacts(scanner), scannerProblem(scanner) ?? "", scanner.scan ? h("a", { href: `#/scans/${scanner.scan}` }, words.scanUnderWay) : "");
  };
  const calibrations = h("section", { class: "card" }, h("h2", {}, texts.calibration.title));
  view.append(
    heading(name, badge, h("a", { class: "button primary", href: `#/scans/new/${name}` }, texts.scans.new), h("a", { class: "button", href: `#/scanners/${name}/calibrate` }, texts.calibration.begin)),
    h("div", { class: "columns wide" }, h("div", {}, preview(visit, path), calibrations), h("div", {}, h("section", { class: "card" }, state), byHand(visit, name, path))));
  await look();
  calibrations.append(...(await calibrationsOf(visit, path)));
  void (async () => {
    for (;;) {
      await pause(kLook, signal);
      // Ignores an error, because the next poll follows soon.
      await look().catch(() => undefined);
    }
  })().catch(() => undefined);
  return name;
};
