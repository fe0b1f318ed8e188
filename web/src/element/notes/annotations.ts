// SPDX-License-Identifier: Apache-2.0
// Reads notes on points of a model, and tours through them.
//
// A page's own file of notes is a list of {"position": [x, y, z], "normal": [x, y, z], "title": "...", "text": "..."} in model
// coordinates, or an object with that list as `annotations`. `normal` and `text` are optional. The daemon's notes and tours are
// described by the schemas Note and Tour of its API.

import type { PresentedLight } from "../../core/presentation.ts";

export type Triple = [number, number, number];

/** A view in model coordinates, so that it stays the same if the presentation of the model changes. */
export interface NoteView {
  /** From the target to the eye. */
  direction: Triple;
  /** The point in the middle of the view. Missing: the centre of the model. */
  target?: Triple;
  /** 1 shows the whole model. */
  zoom?: number;
}

export interface NoteText {
  title: string;
  text?: string;
  alt?: string;
  audio?: string;
}

/** A note as the daemon stores it. */
export interface StoredNote {
  id: string;
  position: Triple;
  normal?: Triple;
  texts: Record<string, NoteText>;
  picture?: string;
  view?: NoteView;
  /** Settings of the light and the section, in the same form as in shared links. */
  light?: string;
  section?: string;
}

/** A tour as the daemon stores it. */
export interface StoredTour {
  id: string;
  titles: Record<string, string>;
  steps: { note: string; seconds?: number; transition?: "fly" | "cut" }[];
}

/** A note in one language. */
export interface Annotation extends Partial<Pick<StoredNote, "id" | "picture" | "view" | "light" | "section">> {
  position: Triple;
  normal: Triple | undefined;
  title: string;
  text: string;
  alt?: string;
  audio?: string;
  /** The language of the texts, if known. */
  language?: string;
}

/**
 * Parses three numbers from a list, or from a text as in model-viewer, such as "0.1m 2cm 3".
 * Ignores units in the text, because all numbers are in model units. Returns undefined if `value`
 * is malformed.
 */
export function triple(value: unknown): Triple | undefined {
  const parts = typeof value === "string" ? value.trim().split(/\s+/).map(Number.parseFloat) : value;
  return Array.isArray(parts) && parts.length === 3 && parts.every(Number.isFinite) ? (parts as Triple) : undefined;
}

/** Returns the notes in `json`. Throws if `json` is malformed. The error names the faulty entry. */
export function readAnnotations(json: unknown): Annotation[] {
  const list = Array.isArray(json) ? json : (json as { annotations?: unknown } | null)?.annotations;
  if (!Array.isArray(list)) throw new Error("no list of annotations");
  return list.map((entry: Record<string, unknown> | null, i) => {
    const position = triple(entry?.["position"]), title = entry?.["title"];
    if (!entry || !position || typeof title !== "string") throw new Error(`annotation ${i + 1} lacks a position or a title`);
    const { normal, text } = entry;
    return { position, normal: triple(normal), title, text: typeof text === "string" ? text : "" };
  });
}

/**
 * Chooses the entry for a language tag: that of the tag itself, else one of the same language, else English, else the
 * first. Returns its tag, or undefined if there is no entry.
 */
export function languageIn(entries: Record<string, unknown>, wanted: string): string | undefined {
  const tags = Object.keys(entries), primary = (tag: string) => tag.toLowerCase().split("-")[0];
  return tags.find((tag) => tag.toLowerCase() === wanted.toLowerCase()) ?? tags.find((tag) => primary(tag) === primary(wanted))
    ?? tags.find((tag) => primary(tag) === "en") ?? tags[0];
}

/** Returns the text by which a note stores the light that the viewer shows. Null stands for the museum's light. */
export function lightOf(shown: PresentedLight | null): string {
  return shown === null ? "museum" : shown.preset === "raking" ? `raking,${shown.angle}` : shown.preset;
}

/**
 * Returns a note of the daemon in the language `wanted`, or in another if it lacks this one. Addresses of pictures and sounds
 * are relative to `api`, the URL of the model in the daemon's API, because another site may embed the viewer.
 */
export function inLanguage({ id, position, normal, texts, view, light, section, ...media }: StoredNote, wanted: string, api: string | undefined): Annotation {
  const language = languageIn(texts, wanted), words = language === undefined ? { title: "" } : (texts[language] as NoteText);
  const picture = absolute(media.picture, api), audio = absolute(words.audio, api);
  return {
    id, position, normal, title: words.title, text: words.text ?? "",
    ...(words.alt && { alt: words.alt }), ...(audio && { audio }), ...(language && { language }),
    ...(picture && { picture }), ...(view && { view }), ...(light !== undefined && { light }), ...(section !== undefined && { section }),
  };
}

function absolute(url: string | undefined, base: string | undefined): string | undefined {
  try {
    return url && new URL(url, base).href;
  } catch {
    return url; // an operator is still typing the address
  }
}
