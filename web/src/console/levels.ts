// SPDX-License-Identifier: Apache-2.0
// Shows the levels of a model as a curve of error over bytes, and as a table.
import { h } from "../ui/dom.ts";
import { count, measure, size } from "../ui/texts/index.ts";
import { table } from "./parts.ts";
import { texts } from "./texts/index.ts";
import type { Manifest } from "./types.ts";

const words = texts.levels;
const kWidth = 640, kHeight = 220, kLeft = 64, kBottom = 34, kMargin = 12;
const kSvg = "http://www.w3.org/2000/svg";

export function levelReport(manifest: Manifest): Node[] {
  const { levels, lattice, bounding_box: { min, max } } = manifest;
  // The report describes the file. If the model is scaled, the numbers in the file are not in the model's unit.
  const unit = (manifest.presentation.scale === 1 && manifest.unit) || words.units;
  const extent = min.map((low, axis) => measure((max[axis] ?? 0) - low)).join(" × ");
  const rows = levels.map((level, i) => [String(i), count(level.faces), size(level.cumulative_bytes), measure(level.rms_error), measure(level.max_error)]);
  return [
    h("h2", {}, words.title),
    h("p", { class: "quiet" }, words.extent(extent, unit, lattice.bits, measure(lattice.step))),
    curve(levels.map(({ cumulative_bytes: x, max_error: y }) => ({ x, y })), `${words.error} (${unit})`),
    h("details", {}, h("summary", {}, words.table), table(words.title, [words.level, words.triangles, words.bytes, `rms (${unit})`, `max (${unit})`], rows)),
  ];
}

interface PlotPoint {
  x: number;
  y: number;
}

function svg(tag: string, attributes: Record<string, string | number>, text = ""): SVGElement {
  const made = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  made.textContent = text;
  return made;
}

/** Draws the points as a curve. Both axes are logarithmic, so points with a coordinate of 0 cannot be shown. */
function curve(all: PlotPoint[], label: string): SVGElement {
  const points = all.filter(({ x, y }) => x > 0 && y > 0);
  const across = scale(points.map(({ x }) => x), kLeft, kWidth - kMargin), up = scale(points.map(({ y }) => y), kHeight - kBottom, kMargin);
  const path = points.map(({ x, y }, i) => `${i ? "L" : "M"}${across(x).toFixed(1)} ${up(y).toFixed(1)}`).join("");
  const made = svg("svg", { viewBox: `0 0 ${kWidth} ${kHeight}`, role: "img", "aria-label": words.curve, class: "curve" });
  made.append(
    svg("path", { class: "axis", d: `M${kLeft} ${kMargin}V${kHeight - kBottom}H${kWidth - kMargin}` }),
    ...ends(points.map(({ x }) => x)).map((x, i) => svg("text", { x: across(x), y: kHeight - kBottom + 16, "text-anchor": i ? "end" : "start" }, size(x))),
    ...ends(points.map(({ y }) => y)).map((y) => svg("text", { x: kLeft - 6, y: up(y) + 4, "text-anchor": "end" }, measure(y))),
    svg("text", { x: kWidth - kMargin, y: kMargin + 8, "text-anchor": "end" }, label),
    svg("path", { class: "line", d: path }),
    ...points.map(({ x, y }) => svg("circle", { cx: across(x), cy: up(y), r: 3.5 })));
  return made;
}

const ends = (values: number[]): number[] => (values.length ? [Math.min(...values), Math.max(...values)] : []);

function scale(values: number[], from: number, to: number): (value: number) => number {
  const [low = 1, high = 1] = ends(values), reach = Math.log(high / low) || 1;
  return (value) => from + ((to - from) * Math.log(value / low)) / reach;
}
