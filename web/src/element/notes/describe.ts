// SPDX-License-Identifier: Apache-2.0
// Makes the elements that show a note's text, picture and sound. Texts of a note never become HTML.
import type { make as makeElement } from "../tools/dom.ts";
import type { Annotation } from "./annotations.ts";
import { paragraphsOf } from "./paragraphs.ts";

/** Returns the elements below the title of a note. The browser loads the picture when it is seen, and the sound when it is played. */
export function describe(make: typeof makeElement, { text, picture, alt = "", audio }: Annotation): HTMLElement[] {
  const made: HTMLElement[] = paragraphsOf(text).map((pieces) => make("p", {}, ...pieces.map((piece) =>
    typeof piece === "string" ? piece : make("a", { href: piece.url, target: "_blank", rel: "noopener" }, piece.label))));
  if (picture) made.push(make("img", { alt, loading: "lazy", referrerpolicy: "no-referrer", src: picture }));
  if (audio) made.push(make("audio", { controls: true, preload: "none", src: audio }));
  return made;
}
