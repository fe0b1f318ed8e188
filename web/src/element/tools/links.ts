// SPDX-License-Identifier: Apache-2.0
// Links that a visitor can share: to the current view, and to files at a level of detail.
import { formatView, parseView, type OrbitView } from "./view.ts";

export const kFormats = ["glb", "ply", "obj", "stl", "drc", "wrl"] as const;
export type ExportDetail = { level: "lowest" | "highest" } | { triangles: number };

/** Returns the key of an element's view in the URL fragment. An element with an ID has its own key. */
function key(id: string): string {
  return id ? `view-${id}` : "view";
}

/** Returns the URL `page` with the view in its fragment; other keys of the fragment are kept. */
export function linkTo(page: string, id: string, view: OrbitView): string {
  const url = new URL(page), words = new URLSearchParams(url.hash.slice(1));
  words.set(key(id), formatView(view));
  url.hash = words.toString().replaceAll("%2C", ",");
  return url.href;
}

export function viewIn(fragment: string, id: string): OrbitView | undefined {
  return parseView(new URLSearchParams(fragment.replace(/^#/, "")).get(key(id)) ?? "");
}

/** Returns the API URL of a model, given the URL of its page or its API URL; undefined for a .pmesh file. */
export function apiOf(src: string): string | undefined {
  const model = /^(.*?)\/(?:api\/v1\/)?models\/([^/.]+)\/?$/.exec(new URL(src).pathname);
  return model ? `${new URL(src).origin}${model[1]}/api/v1/models/${model[2]}` : undefined;
}

export function exportOf(api: string, format: string, amount: ExportDetail): string {
  const [[name, value] = []] = Object.entries(amount);
  return `${api}/export.${format}?${name}=${value}`;
}
