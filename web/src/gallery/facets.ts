// SPDX-License-Identifier: Apache-2.0
// The facets beside the gallery: the most frequent subjects, creators and so on of the objects found, each with a count. A click
// narrows the search to a value, another click widens it again.
import type { FacetName, Facets } from "../ui/api.ts";
import { h } from "../ui/dom.ts";
import { count, texts } from "../ui/texts/index.ts";

export const kFacetNames: readonly FacetName[] = ["subject", "creator", "period", "material", "licence", "collection"];

/** Number of values of a facet that are shown before the visitor asks for more. */
const kFirst = 8;

export type Chosen = Partial<Record<FacetName, string>>;

/** Returns the groups of values of the facets `names`. `choose` is called with the new choice. */
export function facetGroups({ facets }: Facets, chosen: Chosen, choose: (chosen: Chosen) => void, names = kFacetNames): HTMLElement[] {
  const value = (name: FacetName, text: string, models: number) => {
    const isChosen = chosen[name] === text;
    const turn = () => {
      const { [name]: _, ...others } = chosen;
      choose(isChosen ? others : { ...others, [name]: text });
    };
    return h("li", {}, h("button", { type: "button", "aria-pressed": String(isChosen), onclick: turn }, h("span", {}, text), " ",
      h("span", { class: "quiet" }, count(models))));
  };
  return names.flatMap((name) => {
    const values = facets[name].map(({ value: text, models }) => value(name, text, models));
    const rest = values.splice(kFirst);
    if (values.length === 0) return [];
    return [h("section", {}, h("h2", {}, texts.facts[name]), h("ul", {}, ...values),
      rest.length > 0 && h("details", {}, h("summary", {}, texts.moreValues(count(rest.length))), h("ul", {}, ...rest)))];
  });
}
