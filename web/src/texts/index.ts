// SPDX-License-Identifier: Apache-2.0
// The viewer's texts in the language of where it stands.
import { de } from "./de.ts";
import { en, type Texts } from "./en.ts";

export type { Texts };

const kLanguages: Record<string, Texts> = { en, de };

/** For "de-AT", those of "de"; English where there are none. */
export function textsIn(language: string): Texts {
  return kLanguages[language.toLowerCase().split("-")[0] ?? ""] ?? en;
}

/** The `lang` of the element itself, or of what it stands in. */
export function textsFor(element: Element): Texts {
  return textsIn(element.closest<HTMLElement>("[lang]")?.lang ?? "");
}
