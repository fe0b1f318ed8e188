// SPDX-License-Identifier: Apache-2.0
// Notes on places of a model, as a page's JSON file states them: a list of
// {"position": [x, y, z], "normal": [x, y, z], "title": "...", "text": "..."}, `normal` and `text` optional,
// or an object with that list as `annotations`. Model coordinates.

export type Triple = [number, number, number];

export interface Annotation {
  position: Triple;
  normal: Triple | undefined;
  title: string;
  text: string;
}

/** Three numbers of a list or, as model-viewer writes them, of a text: "0.1m 2cm 3" (the unit is the model's). */
export function triple(value: unknown): Triple | undefined {
  const parts = typeof value === "string" ? value.trim().split(/\s+/).map(Number.parseFloat) : value;
  return Array.isArray(parts) && parts.length === 3 && parts.every(Number.isFinite) ? (parts as Triple) : undefined;
}

/** Throws where it is no such file; the message names the entry. */
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
