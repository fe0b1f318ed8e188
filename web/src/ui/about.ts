// SPDX-License-Identifier: Apache-2.0
// The description of an object, and its downloads.
import type { ModelRecord } from "./api.ts";
import { copyable } from "./copy.ts";
import { h } from "./dom.ts";
import { count, measure, size, texts } from "./texts/index.ts";

export function about(model: ModelRecord): Node[] {
  return [
    h("h2", {}, texts.about),
    h("div", { class: "description" }, ...(model.description ?? "").split(/\n+/).filter(Boolean).map((text) => h("p", {}, text))),
    h("dl", {}, ...facts(model).flatMap(([name, value]) => [h("dt", {}, texts.facts[name]), h("dd", {}, value)])),
    h("h3", {}, texts.download),
    downloads(model),
    h("h3", {}, texts.embed),
    h("p", { class: "quiet" }, texts.embedHint),
    copyable(texts.embed, snippet(model, location.origin)),
    h("p", {}, h("a", { href: `/iiif/${model.id}/manifest.json` }, texts.iiif)),
  ];
}

type Fact = [name: keyof typeof texts.facts, value: Node | string];

function facts(model: ModelRecord): Fact[] {
  const { creator, date, subject, coverage, publisher, contributor, identifier, source, relation, language, type, rights } = model;
  const metadata = { creator, date, subject, coverage, publisher, contributor, identifier, source, relation, language, type, rights };
  return [
    ...(Object.entries(metadata) as [Fact[0], string | undefined][]).flatMap(([name, value]): Fact[] => (value ? [[name, linked(value)]] : [])),
    ...(model.licence ? [["licence", licence(model.licence)] as Fact] : []),
    ...(model.unit ? [["unit", texts.units[model.unit]] as Fact] : []),
    ...(model.accuracy === null ? [] : [["accuracy", `± ${measure(model.accuracy)} ${model.unit}`] as Fact]),
    ["detail", texts.amount(count(model.faces), size(model.bytes))],
  ];
}

/** Returns a link if the text is a URL, else the text. */
function linked(text: string): Node | string {
  return /^https?:\/\/\S+$/.test(text) ? h("a", { href: text, rel: "noopener" }, text.replace(/^https?:\/\//, "")) : text;
}

/**
 * Returns a link to the licence's page if `text` is a URL or the SPDX identifier of a Creative Commons licence, else
 * `text`.
 */
function licence(text: string): Node | string {
  const [, kind, version] = /^CC-(BY[A-Z-]*)-(\d\.\d)$/.exec(text) ?? [];
  if (kind && version) return h("a", { href: `https://creativecommons.org/licenses/${kind.toLowerCase()}/${version}/`, rel: "license noopener" }, text);
  if (text === "CC0-1.0") return h("a", { href: "https://creativecommons.org/publicdomain/zero/1.0/", rel: "license noopener" }, text);
  return linked(text);
}

type Format = keyof typeof texts.formats;
type Detail = keyof typeof texts.levels;

/** Returns the download URL of the model in a format and level of detail. */
export function downloadOf(model: ModelRecord, format: Format, detail: Detail): string {
  if (format === "pmesh") return model.links.file;
  const query = detail === "highest" || detail === "lowest" ? `level=${detail}` : `triangles=${detail}`;
  return `${model.links.self}/export.${format}?${query}`;
}

function downloads(model: ModelRecord): HTMLElement {
  const options = (names: Record<string, string>) => Object.entries(names).map(([value, name]) => h("option", { value }, name));
  const levels = Object.entries(texts.levels).filter(([name]) => !(Number(name) >= model.faces));
  const format = h("select", {}, ...options(texts.formats)), level = h("select", {}, ...options(Object.fromEntries(levels)));
  level.value = "highest"; // not the first option, because objects list numeric keys first
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

/** Returns HTML that embeds the object in a page of another site. */
export function snippet({ links, title }: ModelRecord, origin: string): string {
  return `<script type="module" src="${origin}/progressive-mesh.js"></script>\n` +
    `<progressive-mesh src="${origin}${links.self}" alt="${escaped(title || texts.untitled)}"></progressive-mesh>`;
}
