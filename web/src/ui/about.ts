// SPDX-License-Identifier: Apache-2.0
// The description of an object, and its downloads.
import type { ModelRecord, MoreTexts } from "./api.ts";
import { copyable, quotable } from "./copy.ts";
import { h } from "./dom.ts";
import { drawn, iconOfStatement, iconsOfLicence, type RightsIcon } from "./rights-icons.ts";
import { rightsLabel } from "./rights.ts";
import { count, date, measure, size, texts } from "./texts/index.ts";

export function about(model: ModelRecord): Node[] {
  return [
    h("h2", {}, texts.about),
    h("div", { class: "description" }, ...(model.description ?? "").split(/\n+/).filter(Boolean).map((text) => h("p", {}, text))),
    h("dl", {}, ...facts(model).flatMap(([name, value]) => [h("dt", {}, texts.facts[name]), h("dd", {}, value)])),
    ...citations(model),
    h("div", { class: "offers" },
      h("h3", {}, texts.download),
      downloads(model),
      h("h3", {}, texts.embed),
      h("p", { class: "quiet" }, texts.embedHint),
      copyable(texts.embed, snippet(model, location.origin)),
      h("p", { class: "quiet" }, texts.frameHint),
      copyable(texts.embed, frame(model, location.origin)),
      h("p", {}, h("a", { href: `/iiif/${model.id}/manifest.json` }, texts.iiif)),
      h("p", {}, h("a", { href: `/compare.html?left=${model.id}` }, texts.compare.other))),
    printed(model),
  ];
}

/** The names of the styles, which are the same in all languages. */
const kStyles = { apa: "APA", chicago: "Chicago", mla: "MLA" };

/** Returns how to cite the object, in each style. */
function citations({ citation }: ModelRecord): HTMLElement[] {
  if (!citation) return [];
  const styles = Object.entries(kStyles) as [keyof typeof kStyles, string][];
  return [h("section", { class: "citations" },
    h("h3", {}, texts.cite),
    ...styles.flatMap(([style, name]) => [h("h4", {}, name), quotable(name, citation[style])]))];
}

/** Returns the line that only the printed page has. It states the address and the day of printing. */
function printed({ links }: ModelRecord): HTMLElement {
  const line = h("p", { class: "printed" });
  const write = () => (line.textContent = `${location.origin}${links.page}, ${texts.viewed(date(new Date().toISOString()))}.`);
  addEventListener("beforeprint", write);
  write();
  return line;
}

type Fact = [name: keyof typeof texts.facts, value: Node | string];

const kFacts = ["creator", "date", "period", "place", "coverage", "subject", "material", "technique", "identifier", "provenance",
  "publisher", "contributor", "source", "relation", "language", "type", "scan_device", "scan_calibration", "scan_date", "scan_software",
  "collection", "persistent_identifier"] as const;

function facts(model: ModelRecord): Fact[] {
  const named = (names: readonly (keyof MoreTexts | "creator" | "rights")[]) =>
    names.flatMap((name): Fact[] => (model[name] ? [[name as Fact[0], name === "collection" ? collections(model[name]) : linked(model[name])]] : []));
  const { dimensions, doi, rights_statement: statement } = model;
  return [
    ...named(kFacts),
    ...(doi ? [["doi", h("a", { href: `https://doi.org/${encodeURI(doi).replaceAll("#", "%23").replaceAll("?", "%3F")}`, rel: "noopener" }, doi)] as Fact] : []),
    ...(dimensions ? [["dimensions", texts.dimensions(measure(dimensions.width), measure(dimensions.height), measure(dimensions.depth), dimensions.unit)] as Fact] : []),
    ...named(["rights"]),
    ...(statement ? [["rights_statement", marked(iconOfStatement(statement), h("a", { href: statement, rel: "license noopener" }, rightsLabel(statement)))] as Fact] : []),
    ...(model.licence ? [["licence", marked(iconsOfLicence(model.licence), licence(model.licence))] as Fact] : []),
    ...(model.unit ? [["unit", texts.units[model.unit]] as Fact] : []),
    ...(model.accuracy === null ? [] : [["accuracy", `± ${measure(model.accuracy)} ${model.unit}`] as Fact]),
    ["detail", texts.amount(count(model.faces), size(model.bytes))],
  ];
}

/** Returns links to the pages of collections, whose names are separated by semicolons. */
function collections(names: string): Node {
  const links = names.split(";").map((name) => name.trim()).filter(Boolean).map((name) => h("a", { href: `/collections/${encodeURIComponent(name)}` }, name));
  return h("span", {}, ...links.flatMap((link, at) => (at > 0 ? ["; ", link] : [link])));
}

/** Returns a link if the text is a URL. Otherwise returns the text. */
function linked(text: string): Node | string {
  return /^https?:\/\/\S+$/.test(text) ? h("a", { href: text, rel: "noopener" }, text.replace(/^https?:\/\//, "")) : text;
}

/**
 * Returns a link to the page of the licence if `text` is a URL or names a Creative Commons licence,
 * such as CC-BY-4.0. Otherwise returns `text`.
 */
function licence(text: string): Node | string {
  const [, kind, version, place] = /^CC-(BY[A-Z-]*?)-(\d\.\d)(?:-([A-Z]+))?$/.exec(text) ?? [];
  const path = [kind, version, place].filter(Boolean).join("/").toLowerCase();
  if (path) return h("a", { href: `https://creativecommons.org/licenses/${path}/`, rel: "license noopener" }, text);
  if (text === "CC0-1.0") return h("a", { href: "https://creativecommons.org/publicdomain/zero/1.0/", rel: "license noopener" }, text);
  return linked(text);
}

/** Returns the label with icons before it, if there are any. */
function marked(icons: RightsIcon[], label: Node | string): Node | string {
  return icons.length > 0 ? h("span", {}, drawn(icons), label) : label;
}

type Format = keyof typeof texts.formats;
type Detail = keyof typeof texts.levels;

/** Returns the URL for downloading the model in a format and a level of detail. */
export function downloadOf(model: ModelRecord, format: Format, detail: Detail): string {
  if (format === "pmesh") return model.links.file;
  const query = detail === "highest" || detail === "lowest" ? `level=${detail}` : `triangles=${detail}`;
  return `${model.links.self}/export.${format}?${query}`;
}

function downloads(model: ModelRecord): HTMLElement {
  const options = (names: Record<string, string>) => Object.entries(names).map(([value, name]) => h("option", { value }, name));
  const levels = Object.entries(texts.levels).filter(([name]) => !(Number(name) >= model.faces));
  const format = h("select", {}, ...options(texts.formats)), level = h("select", {}, ...options(Object.fromEntries(levels)));
  // Selects the default. It is not the first option, because JavaScript puts numeric keys before
  // others.
  level.value = "highest";
  const link = h("a", { class: "button", download: true }, texts.download);
  const follow = () => {
    level.disabled = format.value === "pmesh";
    link.href = downloadOf(model, format.value as Format, level.value as Detail);
  };
  for (const select of [format, level]) select.addEventListener("change", follow);
  follow();
  return h("div", { class: "downloads" }, h("label", {}, texts.format, format), h("label", {}, texts.level, level), link);
}

const escaped = (text: string) => text.replace(/[&<>"]/g, (letter) => `&#${letter.charCodeAt(0)};`);

const kShape = "width: 100%; aspect-ratio: 4 / 3";

/** Returns HTML code that embeds the object in a page of another site. */
export function snippet({ links, title }: ModelRecord, origin: string): string {
  return `<script type="module" src="${origin}/progressive-mesh.js"></script>\n` +
    `<progressive-mesh src="${origin}${links.self}" alt="${escaped(title || texts.untitled)}" camera-controls ar ` +
    `poster="${origin}${links.self}/poster.png?width=960" style="${kShape}"></progressive-mesh>`;
}

/** Returns HTML code that shows the object's page in a frame, for sites whose editors remove scripts. */
export function frame({ links, title }: ModelRecord, origin: string): string {
  return `<iframe src="${origin}${links.page}" title="${escaped(title || texts.untitled)}" allow="fullscreen; web-share; xr-spatial-tracking" style="${kShape}; border: 0"></iframe>`;
}
