// SPDX-License-Identifier: Apache-2.0
// Reads notes from a file: one that the console has saved, or a page of IIIF annotations at points of the model's scene.
import type { StoredNote, StoredTour } from "../element/notes/annotations.ts";
import type { Presentation } from "../core/presentation.ts";

export interface NoteFile {
  notes: StoredNote[];
  tours: StoredTour[];
  /** Whether the file replaces the present notes. Annotations are added to them. */
  isWhole: boolean;
}

type Vector = [number, number, number];

/** The transform from the coordinates of the model's file to those of the IIIF scene, which are the coordinates of the GLB. */
export interface SceneScale {
  presentation: Pick<Presentation, "rotation" | "scale">;
  unit: string;
}

const kMetres: Record<string, number> = { mm: 0.001, cm: 0.01, m: 1, in: 0.0254 };

interface Body {
  type?: string;
  id?: string;
  value?: string;
  language?: string;
}
interface IiifAnnotation {
  label?: Record<string, string[]>;
  body?: Body | Body[];
  target?: { selector?: Selector | Selector[] };
}
type Selector = { type?: string; x?: number; y?: number; z?: number };

const listOf = <T>(value: T | T[] | undefined): T[] => (Array.isArray(value) ? value : value === undefined ? [] : [value]);

/** Returns a point of the scene in the coordinates of the model's file. */
export function inFile([x, y, z]: Vector, { presentation: { rotation: [a, b, c, w], scale }, unit }: SceneScale): Vector {
  const size = scale * (kMetres[unit] ?? 1), [px, py, pz] = [x / size, y / size, z / size];
  // Turns by the inverse of the rotation: v + 2w (v × q) + 2 (v × q) × q for the vector part q.
  const [ux, uy, uz] = [py * c - pz * b, pz * a - px * c, px * b - py * a];
  const [tx, ty, tz] = [uy * c - uz * b, uz * a - ux * c, ux * b - uy * a];
  return [px + 2 * (w * ux + tx), py + 2 * (w * uy + ty), pz + 2 * (w * uz + tz)];
}

/** Reads a file. `newId` returns IDs for annotations. Throws if the file has no notes; `missing` is the message. */
export function readNoteFile(text: string, scale: SceneScale, newId: () => string, missing: string): NoteFile {
  let json: { type?: string; items?: IiifAnnotation[]; notes?: StoredNote[]; tours?: StoredTour[] } | null = null;
  try {
    json = JSON.parse(text);
  } catch {
    throw new Error(missing);
  }
  if (Array.isArray(json?.notes)) return { notes: json.notes, tours: json.tours ?? [], isWhole: true };
  const notes = listOf(json?.items).flatMap((item) => noteOf(item, scale, newId));
  if (json?.type !== "AnnotationPage" || notes.length === 0) throw new Error(missing);
  return { notes, tours: [], isWhole: false };
}

function noteOf({ label = {}, body, target }: IiifAnnotation, scale: SceneScale, newId: () => string): StoredNote[] {
  const { x, y, z } = listOf(target?.selector).find(({ type }) => type === "PointSelector") ?? {};
  if (x === undefined || y === undefined || z === undefined) return [];
  const bodies = listOf(body), texts: StoredNote["texts"] = {};
  for (const { type, value = "", language = "en" } of bodies) {
    if (type !== "TextualBody") continue;
    const title = label[language]?.[0] ?? label["none"]?.[0] ?? "";
    const [first = "", ...rest] = value.split("\n");
    texts[language] = title ? { title, ...(value !== title && { text: value }) } : { title: first.slice(0, 100) || "…", text: rest.join("\n").trim() };
  }
  for (const { type, id, language = "en" } of bodies) if (type === "Sound" && id && texts[language]) texts[language].audio = id;
  const picture = bodies.find(({ type }) => type === "Image")?.id;
  if (Object.keys(texts).length === 0) return [];
  return [{ id: newId(), position: inFile([x, y, z], scale), texts, ...(picture && { picture }) }];
}
