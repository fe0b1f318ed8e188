// SPDX-License-Identifier: Apache-2.0
// Reads notes from a file: one that the console has saved, or a page of IIIF annotations at points of the model's scene.
import type { NoteText, StoredNote, StoredTour } from "../element/notes/annotations.ts";
import type { Presentation } from "../core/presentation.ts";
import { isAnnotation, isNoteList, isObject, isTourList, type IiifAnnotation } from "./note-checks.ts";

export interface NoteFile {
  notes: StoredNote[];
  tours: StoredTour[];
  /** Whether the file replaces the present notes. Annotations are added to them. */
  isWhole: boolean;
}

type Vector = [number, number, number];

/** The transform from the coordinates of the model's file to those of the IIIF scene, which are the coordinates of an exported GLB. */
export interface SceneScale {
  presentation: Pick<Presentation, "rotation" | "scale">;
  unit: string;
}

const kMostTitle = 200; // maximum length of a title, in bytes of UTF-8
const kMetres: Record<string, number> = { mm: 0.001, cm: 0.01, m: 1, in: 0.0254 };

const listOf = <T>(value: T | T[] | undefined): T[] => (Array.isArray(value) ? value : value === undefined ? [] : [value]);

/** Returns a point of the scene in the coordinates of the model's file. */
export function inFile([x, y, z]: Vector, { presentation: { rotation: [a, b, c, w], scale }, unit }: SceneScale): Vector {
  const size = scale * (kMetres[unit] ?? 1), [px, py, pz] = [x / size, y / size, z / size];
  // Turns by the inverse of the rotation: v + 2w (v × q) + 2 (v × q) × q for the vector part q.
  const [ux, uy, uz] = [py * c - pz * b, pz * a - px * c, px * b - py * a];
  const [tx, ty, tz] = [uy * c - uz * b, uz * a - ux * c, ux * b - uy * a];
  return [px + 2 * (w * ux + tx), py + 2 * (w * uy + ty), pz + 2 * (w * uz + tz)];
}

/** Reads a file. `newId` returns IDs for annotations. Throws if the file is malformed or has no notes; `missing` is the message. */
export function readNoteFile(text: string, scale: SceneScale, newId: () => string, missing: string): NoteFile {
  const json = jsonOf(text);
  if (isObject(json) && Array.isArray(json["notes"])) {
    const { notes, tours = [] } = json;
    if (!isNoteList(notes) || !isTourList(tours)) throw new Error(missing);
    return { notes, tours, isWhole: true };
  }
  const items = isObject(json) && json["type"] === "AnnotationPage" ? listOf(json["items"]) : [];
  if (!items.every(isAnnotation)) throw new Error(missing);
  const notes = items.flatMap((item) => noteOf(item, scale, newId));
  if (notes.length === 0) throw new Error(missing);
  return { notes, tours: [], isWhole: false };
}

function jsonOf(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return undefined;
  }
}

function noteOf({ label = {}, body, target }: IiifAnnotation, scale: SceneScale, newId: () => string): StoredNote[] {
  const { x, y, z } = listOf(target?.selector).find(({ type }) => type === "PointSelector") ?? {};
  if (x === undefined || y === undefined || z === undefined) return [];
  const bodies = listOf(body), texts: StoredNote["texts"] = {};
  for (const { type, value = "", language = "en" } of bodies)
    if (type === "TextualBody") texts[language] = textOf(plain(label[language]?.[0] ?? label["none"]?.[0] ?? ""), plain(value));
  for (const { type, id, language = "en" } of bodies) if (type === "Sound" && id && texts[language]) texts[language].audio = onDaemon(id);
  const picture = onDaemon(bodies.find(({ type }) => type === "Image")?.id ?? "");
  if (Object.keys(texts).length === 0) return [];
  return [{ id: newId(), position: inFile([x, y, z], scale), texts, ...(picture && { picture }) }];
}

/** Returns the path of a URL on the daemon itself, which serves this page. Returns other URLs as they are. */
function onDaemon(url: string): string {
  const origin = globalThis.location?.origin;
  return origin && url.startsWith(`${origin}/`) ? url.slice(origin.length) : url;
}

/** Returns a text without the tabs and carriage returns that the daemon refuses. */
const plain = (text: string): string => text.replace(/\r\n?/g, "\n").replaceAll("\t", " ");

/** Returns a note's title and text. Without a label, the title is the first line of `value`. The text repeats a title that had to be shortened. */
function textOf(label: string, value: string): NoteText {
  const [first = "", ...rest] = value.split("\n"), whole = label || first, title = shortened(whole) || "…";
  if (title !== whole && whole !== "") return { title, text: !label || label === value ? value : `${label}\n\n${value}`.trim() };
  if (label) return { title, ...(value !== label && { text: value }) };
  return { title, text: rest.join("\n").trim() };
}

/** Returns the beginning of a title, at most as many bytes as the daemon allows. Keeps characters whole. */
function shortened(title: string): string {
  let bytes = 0, end = 0;
  for (const character of title) {
    bytes += new TextEncoder().encode(character).length;
    if (bytes > kMostTitle) return title.slice(0, end);
    end += character.length;
  }
  return title;
}
