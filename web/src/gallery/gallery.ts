// SPDX-License-Identifier: Apache-2.0
// The page "/": what is on display.
import { count, size, texts } from "../texts.ts";
import { models, type ModelRecord } from "./api.ts";

const list = document.getElementById("models") as HTMLUListElement;
const note = document.getElementById("note") as HTMLParagraphElement;

function card(model: ModelRecord): HTMLLIElement {
  const item = document.createElement("li");
  const link = item.appendChild(document.createElement("a"));
  link.href = model.links.page;
  link.appendChild(poster(model));
  link.appendChild(document.createElement("h2")).textContent = model.title || texts.untitled;
  const facts = [model.creator, texts.amount(count(model.faces), size(model.bytes)), model.licence];
  link.appendChild(document.createElement("p")).textContent = facts.filter(Boolean).join(" · ");
  return item;
}

/** Decoration: the title below says what it shows. */
function poster({ links }: ModelRecord): HTMLImageElement {
  const image = document.createElement("img");
  image.loading = "lazy";
  image.alt = "";
  image.width = image.height = 480;
  image.src = links.poster;
  image.onerror = () => image.remove();
  return image;
}

async function fill(): Promise<void> {
  for await (const model of models()) list.append(card(model));
  if (list.childElementCount === 0) say(`${texts.galleryEmpty} ${texts.galleryHint}`);
}

function say(text: string): void {
  note.textContent = text;
  note.hidden = false;
}

document.title = texts.galleryTitle;
(document.getElementById("title") as HTMLElement).textContent = texts.galleryTitle;
fill().catch(() => say(texts.galleryFailed));
