// SPDX-License-Identifier: Apache-2.0
// The viewer's texts in the language of where it stands: a file for each, fetched once it is read.
import type { Texts } from "./en.ts";
import { formats, type Formats } from "./formats.ts";

export type { Texts };

const kLanguages: Record<string, () => Promise<(formats: Formats) => Texts>> = {
  en: async () => (await import("./en.ts")).en,
  de: async () => (await import("./de.ts")).de,
};

const fetched = new Map<string, Promise<Texts>>();

async function fetchTexts(language: string): Promise<Texts> {
  const say = await kLanguages[language]?.();
  return (say as NonNullable<typeof say>)(formats(language));
}

/** For "de-AT", those of "de"; English where there are none. The same promise for the same language. */
export function textsIn(tag: string): Promise<Texts> {
  const wanted = tag.toLowerCase().split("-")[0] ?? "";
  const language = wanted in kLanguages ? wanted : "en";
  const texts = fetched.get(language) ?? fetchTexts(language);
  fetched.set(language, texts);
  return texts;
}

/** By the `lang` of the element itself, or of what it stands in. */
export function textsFor(element: Element): Promise<Texts> {
  return textsIn(element.closest<HTMLElement>("[lang]")?.lang ?? "");
}
