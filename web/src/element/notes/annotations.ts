// SPDX-License-Identifier: Apache-2.0
// Reads notes on points of a model from a page's JSON file. The file is a list of
// {"position": [x, y, z], "normal": [x, y, z], "title": "...", "text": "..."} in model coordinates,
// or an object with that list as `annotations`. `normal` and `text` are optional.

export type Triple = [number, number, number];

export interface Annotation {
  position: Triple;
  normal: Triple | undefined;
  title: string;
  text: string;
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
