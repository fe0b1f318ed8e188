// SPDX-License-Identifier: Apache-2.0
// The viewer's texts in the language of the page that contains the viewer. Each language has its
// own file, which is loaded on demand.
import type { ViewerTexts } from "./en.ts";
import { formats, type Formats } from "./formats.ts";

export type { ViewerTexts };

const kLanguages: Record<string, () => Promise<(formats: Formats) => ViewerTexts>> = {
  en: async () => (await import("./en.ts")).en,
  de: async () => (await import("./de.ts")).de,
  es: async () => (await import("./es.ts")).es,
  fr: async () => (await import("./fr.ts")).fr,
  it: async () => (await import("./it.ts")).it,
};

const fetched = new Map<string, Promise<ViewerTexts>>();

async function fetchTexts(language: string): Promise<ViewerTexts> {
  const say = await kLanguages[language]?.();
  return (say as NonNullable<typeof say>)(formats(language));
}

/**
 * Loads the texts for a language tag. For example, "de-AT" gives German, and an unknown language
 * gives English. Calls for the same language share one promise.
 */
export function textsIn(tag: string): Promise<ViewerTexts> {
  const wanted = tag.toLowerCase().split("-")[0] ?? "";
  const language = wanted in kLanguages ? wanted : "en";
  const texts = fetched.get(language) ?? fetchTexts(language);
  fetched.set(language, texts);
  return texts;
}

/**
 * Loads the texts in the language of an element, which is the nearest `lang` attribute of the
 * element or its ancestors.
 */
export function textsFor(element: Element): Promise<ViewerTexts> {
  return textsIn(element.closest<HTMLElement>("[lang]")?.lang ?? "");
}
