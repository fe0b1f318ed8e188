// SPDX-License-Identifier: Apache-2.0
// The pages "#/scans" (the list of scans) and "#/scans/new" (which starts a scan).
import { h } from "../ui/dom.ts";
import { date, texts as gallery } from "../ui/texts/index.ts";
import type { ConsolePage } from "./desk.ts";
import { field, form, type Values } from "./forms.ts";
import { badge, heading, paged } from "./parts.ts";
import { texts } from "./texts/index.ts";
import type { Calibration, Calibrations, Scan, ScanListPage, Scanner } from "./types.ts";

const words = texts.scans;

function row({ id, title, state, scanner, created, error }: Scan): HTMLElement {
  return h("li", {}, h("a", { class: "card entry", href: `#/scans/${id}` },
    h("span", {}, h("strong", {}, title || gallery.untitled), h("small", {}, [scanner, date(created), error].filter(Boolean).join(" · "))),
    badge(words.states[state], state)));
}

export const scansPage: ConsolePage = async ({ desk, view, signal }) => {
  const list = h("ul", { class: "cards" }), empty = h("p", { class: "quiet", hidden: true }, words.empty);
  view.append(heading(words.title, h("a", { class: "button primary", href: "#/scans/new" }, words.new)), list, empty);
  empty.hidden = (await paged(list, async (cursor) => {
    const { scans, next } = await desk.api.get<ScanListPage>(`/scans${cursor ? `?cursor=${cursor}` : ""}`, signal);
    return { rows: scans.map(row), next };
  })) > 0;
  return words.title;
};

/** Converts the form's values to a request. Omits empty fields, so that the scanner's defaults apply. */
function orderOf({ scanner, title, creator, licence, steps, exposure, calibration, keep_frames, publish }: Values) {
  return {
    scanner, steps, keep_frames, publish, metadata: { title, creator, licence },
    ...(exposure === null ? {} : { exposure }), ...(calibration ? { calibration: Number(calibration) } : {}),
  };
}

export const newScanPage: ConsolePage = async ({ desk, view, signal, words: [wanted] }) => {
  const { scanners } = await desk.api.get<{ scanners: Scanner[] }>("/scanners", signal);
  const chosen = field({ name: "scanner", label: words.scanner, options: scanners.map(({ name }) => [name, name]), value: wanted ?? scanners[0]?.name });
  const calibration = field({ name: "calibration", label: texts.calibration.one, options: [["", texts.calibration.newest]] });
  const select = chosen.querySelector("select") as HTMLSelectElement;
  const offer = (known: Calibration[]) => calibration.querySelector("select")?.replaceChildren(
    h("option", { value: "" }, texts.calibration.newest), ...known.map(({ number, rms }) => h("option", { value: number }, words.calibration(number, rms))));
  const learn = async () => {
    // offers only "newest" until the calibrations arrive, or if they cannot be fetched
    offer([]);
    const { calibrations } = await desk.api.get<Calibrations>(`/scanners/${encodeURIComponent(select.value)}/calibrations`, signal);
    offer(calibrations);
  };
  const begin = async (values: Values) => {
    const { id } = await desk.api.begin<{ id: string }>("/scans", orderOf(values));
    location.hash = `#/scans/${id}`;
  };
  view.append(heading(words.new));
  if (scanners.length === 0) {
    view.append(h("p", { class: "quiet" }, texts.scanners.none));
    return words.new;
  }
  view.append(h("section", { class: "card narrow" }, form([
    chosen,
    field({ name: "title", label: gallery.title, required: true }),
    field({ name: "creator", label: gallery.facts.creator }),
    field({ name: "licence", label: gallery.facts.licence, hint: texts.models.licenceHint }),
    field({ name: "steps", label: words.steps, hint: words.stepsHint, type: "number", min: 1, max: 28800, value: 720, required: true }),
    field({ name: "exposure", label: words.exposure, hint: words.exposureHint, type: "number", min: 1, step: "any" }),
    calibration,
    field({ name: "keep_frames", label: words.keepFrames, hint: words.keepFramesHint, type: "checkbox" }),
    field({ name: "publish", label: words.publish, type: "checkbox" }),
  ], words.start, begin)));
  select.addEventListener("change", () => void learn().catch(() => undefined));
  await learn().catch(() => undefined);
  return words.new;
};
