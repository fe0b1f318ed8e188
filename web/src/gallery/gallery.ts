// SPDX-License-Identifier: Apache-2.0
// The gallery, "/", which shows the published models. A button loads further models. Words, facets
// and order of the search are in the URL's query. The same code serves the page of a collection, "/collections/{name}", which shows
// only the models of that collection.
import { facets, models, type ModelRecord } from "../ui/api.ts";
import { byId, h, square } from "../ui/dom.ts";
import { count, language, size, texts } from "../ui/texts/index.ts";
import { facetGroups, kFacetNames, type Chosen } from "./facets.ts";

/** The search starts when the visitor has not typed for this many milliseconds. */
const kRest = 250;
const kPosterSide = 480;

const list = byId<HTMLUListElement>("models"), note = byId("note"), more = byId<HTMLButtonElement>("more"), form = byId<HTMLFormElement>("search");
const input = h("input", { type: "search", name: "q", maxlength: 100, placeholder: texts.searchHint, "aria-label": texts.search, autocomplete: "off" });
const sort = h("select", { name: "sort", "aria-label": texts.sort }, ...Object.entries(texts.orders).map(([value, label]) => h("option", { value }, label)));
const narrowing = byId("facets"), groups = byId("groups");
let chosen: Chosen = {};
/** The collection whose page this is; empty on the page of all models. */
const [, , ownCollection = ""] = location.pathname.startsWith("/collections/") ? location.pathname.split("/").map(decodeURIComponent) : [];
const own: Chosen = ownCollection ? { collection: ownCollection } : {};

function card(model: ModelRecord): HTMLLIElement {
  const facts = [model.creator, texts.amount(count(model.faces), size(model.bytes)), model.licence].filter(Boolean);
  return h("li", {}, h("a", { href: model.links.page },
    // The poster has no alternative text, because the title below says what it shows.
    h("div", { class: "poster" }, square(model.links.poster, kPosterSide)),
    h("h2", {}, model.title || texts.untitled), h("p", {}, facts.join(" · "))));
}

class Display {
  #cursor: string | null = null;
  #asked = 0;

  /** Starts a new search at its first page. Responses to earlier requests are ignored from now on. */
  search(words: string): Promise<void> {
    this.#cursor = null;
    void this.#count(words);
    return this.#ask(words, true);
  }

  /** Shows the facets of the search. If there is no response, the facets shown before stay. */
  async #count(words: string): Promise<void> {
    const wanted = chosen, found = await facets(words, { ...wanted, ...own }).catch(() => null);
    if (!found || wanted !== chosen || words !== input.value.trim()) return;
    const focused = document.activeElement?.closest("#groups button")?.firstElementChild?.textContent;
    groups.replaceChildren(...facetGroups(found, chosen, (now) => ((chosen = now), find()), kFacetNames.filter((name) => !(name in own))));
    narrowing.hidden = groups.childElementCount === 0;
    [...groups.querySelectorAll("button")].find((button) => button.firstElementChild?.textContent === focused)?.focus();
    if (isNarrowed(words) && found.models > 0) say(texts.found(count(found.models)));
  }

  more(): Promise<void> {
    return this.#ask(input.value.trim(), false);
  }

  async #ask(words: string, isFresh: boolean): Promise<void> {
    const question = ++this.#asked;
    more.disabled = true;
    try {
      const page = await models(words, this.#cursor, { ...chosen, ...own, sort: sort.value });
      if (question !== this.#asked) return;
      this.#cursor = page.next;
      const cards = page.models.map(card);
      if (isFresh) list.replaceChildren(...cards);
      else list.append(...cards);
      if (!isFresh) cards[0]?.querySelector("a")?.focus();
      this.#tell(words);
    } catch {
      if (question === this.#asked) say(texts.unreachable);
    }
  }

  #tell(words: string): void {
    const { childElementCount: shown } = list;
    more.disabled = false;
    more.hidden = this.#cursor === null;
    if (shown > 0) say(isNarrowed(words) ? note.textContent ?? "" : "");
    else say(isNarrowed(words) ? texts.nothingFound([words, ...Object.values(chosen)].filter(Boolean).join(", ")) : `${texts.empty} ${texts.emptyHint}`);
  }
}

/** Whether the search leaves out objects. */
function isNarrowed(words: string): boolean {
  return words !== "" || Object.keys(chosen).length > 0;
}

function say(text: string): void {
  note.textContent = text;
}

const display = new Display();
let rest: ReturnType<typeof setTimeout>;

function find(): void {
  clearTimeout(rest);
  const words = input.value.trim();
  const query = new URLSearchParams({ ...(words && { q: words }), ...chosen, ...(sort.value !== "newest" && { sort: sort.value }) });
  history.replaceState(null, "", query.size > 0 ? `?${query}` : location.pathname);
  void display.search(words);
}

document.documentElement.lang = language;
document.title = byId("title").textContent = ownCollection || texts.collection;
if (ownCollection) byId("title").before(h("a", { id: "back", href: "/" }, texts.collection));
more.textContent = texts.more;
more.addEventListener("click", () => void display.more());
form.append(input, sort);
sort.addEventListener("change", find);
byId("narrow").textContent = texts.narrow;
form.addEventListener("submit", (event) => (event.preventDefault(), find()));
input.addEventListener("input", () => {
  clearTimeout(rest);
  rest = setTimeout(find, kRest);
});
byId("footer").append(h("a", { href: "/console" }, texts.console), h("a", { href: "/docs" }, texts.interface));
const query = new URLSearchParams(location.search);
input.value = query.get("q") ?? "";
sort.value = query.get("sort") ?? "newest";
if (sort.value === "") sort.value = "newest";
narrowing.toggleAttribute("open", kFacetNames.some((name) => query.has(name)));
chosen = Object.fromEntries(kFacetNames.flatMap((name) => (query.get(name) ? [[name, query.get(name)]] : []))) as Chosen;
void display.search(input.value.trim());
