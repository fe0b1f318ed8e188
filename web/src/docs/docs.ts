// SPDX-License-Identifier: Apache-2.0
// The page "/docs", which shows the API's OpenAPI document. It loads nothing from other servers.
import { callsOf, type ApiOperation, type Document, type FieldRow } from "./openapi.ts";
import { texts as words } from "./texts.ts";

function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  text = "",
  children: Node[] = [],
): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  made.textContent = text;
  made.append(...children);
  return made;
}

/** Converts text to nodes. Parts in backquotes become <code> elements. */
function prose(text: string): Node[] {
  return text.split("`").map((part, i) => (i % 2 ? element("code", part) : document.createTextNode(part)));
}

function table(caption: string, fields: FieldRow[]): Node[] {
  if (fields.length === 0) return [];
  const rows = fields.map(({ name, type, isRequired, about }) => {
    const row = element("tr", "", [element("th", "", [element("code", name)]), element("td", type), element("td", "", prose(about))]);
    row.className = isRequired ? "required" : "";
    return row;
  });
  return [element("table", "", [element("caption", caption), element("tbody", "", rows)])];
}

function article(call: ApiOperation): HTMLElement {
  const method = element("span", call.method);
  method.className = "method";
  const heading = element("h3", "", [method, element("code", call.path)]);
  const made = element("article", "", [
    heading,
    element("p", "", prose(call.summary)),
    ...(call.role ? [element("p", words.role(call.role))] : []),
    ...table(words.parameters, call.parameters),
    ...table(words.body, call.body),
    element("p", call.answer ? words.answer(call.status, call.answer) : words.answerOnly(call.status)),
    ...table(words.fields, call.fields),
  ]);
  made.id = call.id;
  return made;
}

function show(api: Document): void {
  const sections = new Map<string, HTMLElement>();
  for (const call of callsOf(api)) {
    let section = sections.get(call.noun);
    if (!section) {
      section = element("section", "", [element("h2", call.noun)]);
      section.id = `noun-${call.noun}`;
      sections.set(call.noun, section);
    }
    section.append(article(call));
  }
  for (const noun of sections.keys()) {
    const link = element("a", noun);
    link.href = `#noun-${noun}`;
    document.getElementById("nouns")?.append(link);
  }
  document.getElementById("calls")?.append(...sections.values());
  document.getElementById("summary")?.append(...prose(api.info.description));
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
}

async function load(): Promise<Document> {
  const answer = await fetch("/api/v1/openapi.json");
  if (!answer.ok) throw new Error(String(answer.status));
  return (await answer.json()) as Document;
}

document.title = words.title;
(document.getElementById("title") as HTMLElement).textContent = words.title;
load()
  .then(show)
  .catch(() => document.getElementById("calls")?.append(element("p", words.failed)));
