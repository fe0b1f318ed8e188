// SPDX-License-Identifier: Apache-2.0
// The page "#/models": all models, including drafts, and an area for uploading new models.
import { modelQuery } from "../ui/api.ts";
import { h } from "../ui/dom.ts";
import { date, texts as gallery } from "../ui/texts/index.ts";
import type { ConsolePage, Desk, Visit } from "./desk.ts";
import { field, type Values } from "./forms.ts";
import { heading, modelBadge, paged, triangles } from "./parts.ts";
import { picture } from "./pictures.ts";
import { texts } from "./texts/index.ts";
import { isOver, type ModelListPage, type ModelRecord } from "./types.ts";
import { cardOf, dropZone, interruptedUploads, kUnits, type Making } from "./upload-card.ts";
import type { Sending } from "./uploads.ts";

const words = texts.models;
/** The search starts when the operator has not typed for this many milliseconds. */
const kRest = 250;

function row({ desk, signal }: Visit, model: ModelRecord): HTMLElement {
  const { id, title, creator, faces, created } = model;
  return h("li", {}, h("a", { href: `#/models/${id}`, class: "card entry" },
    picture(desk.api, `/models/${id}/poster.png?width=240`, "", signal),
    h("span", {}, h("strong", {}, title || gallery.untitled), h("small", {}, [creator, triangles(faces), date(created)].filter(Boolean).join(" · "))),
    modelBadge(model)));
}

const stem = (name: string): string => name.replace(/\.gz$/i, "").replace(/\.[^.]+$/, "");

function newModel(sending: Sending): Making {
  const fields = [
    field({ name: "title", label: gallery.title, value: stem(sending.file.name) }),
    field({ name: "creator", label: gallery.facts.creator }),
    field({ name: "licence", label: gallery.facts.licence, hint: words.licenceHint }),
    field({ name: "unit", label: gallery.facts.unit, options: kUnits }),
    field({ name: "up", label: texts.uploads.up, options: [["y", "Y"], ["z", "Z"]] }),
    field({ name: "publish", label: texts.uploads.publish, type: "checkbox" }),
  ];
  const order = ({ title, creator, licence, unit, up, publish }: Values) => ({ metadata: { title, creator, licence }, ...(unit ? { unit } : {}), up, publish });
  return { fields, submit: texts.uploads.make, order };
}

/** Calls `act` whenever a job that makes a model has ended, until `signal` is aborted. */
function onMade(desk: Desk, act: () => void, signal: AbortSignal): void {
  let made: string | undefined;
  desk.jobs.onChange(() => {
    const now = desk.jobs.all.filter((job) => isOver(job) && job.model).map(({ id }) => id).join();
    if (made !== undefined && made !== now) act();
    made = now;
  }, signal);
}

export const modelsPage: ConsolePage = async (visit) => {
  const { desk, view, signal } = visit;
  const list = h("ul", { class: "cards" }), uploads = h("ul", { class: "cards" }), note = h("p", { class: "quiet", role: "status" });
  const search = h("input", { type: "search", placeholder: gallery.searchHint, "aria-label": words.search, maxlength: 100 });
  let asked = 0;
  const fill = async () => {
    const question = ++asked, wanted = search.value.trim();
    const found = await paged(list, async (cursor) => {
      const query = modelQuery(wanted, cursor);
      query.set("drafts", "true");
      const { models, next } = await desk.api.get<ModelListPage>(`/models?${query}`, signal);
      return question === asked ? { rows: models.map((model) => row(visit, model)), next } : { rows: [...list.children], next };
    });
    note.textContent = found > 0 ? "" : wanted ? gallery.nothingFound(wanted) : words.empty;
  };
  const card = (one: Sending) => cardOf(desk, one, () => newModel(one));
  const take = (files: File[]) => {
    for (const file of files) {
      uploads.querySelector(`[data-name="${CSS.escape(file.name)}"]`)?.remove();
      uploads.prepend(card(desk.uploads.add(file)));
    }
  };
  let rest: ReturnType<typeof setTimeout>;
  search.addEventListener("input", () => {
    clearTimeout(rest);
    rest = setTimeout(() => void fill().catch(() => undefined), kRest);
  });
  view.append(heading(words.title, search), dropZone(texts.uploads.drop, take), uploads, list, note);
  uploads.append(...desk.uploads.all.map(card), ...(await interruptedUploads(desk, desk.say)));
  onMade(desk, () => void fill().catch(() => undefined), signal);
  await fill();
  return words.title;
};
