// SPDX-License-Identifier: Apache-2.0
// The gallery, "/", which shows the published models. A button loads further models. The search
// words are in the URL's query.
import { models, type ModelRecord } from "../ui/api.ts";
import { byId, h, square } from "../ui/dom.ts";
import { count, language, size, texts } from "../ui/texts/index.ts";

/** The search starts when the visitor has not typed for this many milliseconds. */
const kRest = 250;
const kPosterSide = 480;

const list = byId<HTMLUListElement>("models"), note = byId("note"), more = byId<HTMLButtonElement>("more"), form = byId<HTMLFormElement>("search");
const input = h("input", { type: "search", name: "q", maxlength: 100, placeholder: texts.searchHint, "aria-label": texts.search, autocomplete: "off" });

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
    return this.#ask(words, true);
  }

  more(): Promise<void> {
    return this.#ask(input.value.trim(), false);
  }

  async #ask(words: string, isFresh: boolean): Promise<void> {
    const question = ++this.#asked;
    more.disabled = true;
    try {
      const page = await models(words, this.#cursor);
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
    if (shown > 0) say(words ? texts.found(count(shown)) : "");
    else say(words ? texts.nothingFound(words) : `${texts.empty} ${texts.emptyHint}`);
  }
}

function say(text: string): void {
  note.textContent = text;
}

const display = new Display();
let rest: ReturnType<typeof setTimeout>;

function find(): void {
  clearTimeout(rest);
  const words = input.value.trim();
  history.replaceState(null, "", words ? `?q=${encodeURIComponent(words)}` : location.pathname);
  void display.search(words);
}

document.documentElement.lang = language;
document.title = byId("title").textContent = texts.collection;
more.textContent = texts.more;
more.addEventListener("click", () => void display.more());
form.append(input);
form.addEventListener("submit", (event) => (event.preventDefault(), find()));
input.addEventListener("input", () => {
  clearTimeout(rest);
  rest = setTimeout(find, kRest);
});
byId("footer").append(h("a", { href: "/console" }, texts.console), h("a", { href: "/docs" }, texts.interface));
input.value = new URLSearchParams(location.search).get("q") ?? "";
void display.search(input.value.trim());
