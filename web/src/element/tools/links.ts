// SPDX-License-Identifier: Apache-2.0
// Addresses that a visitor takes along: of the present view, and of files at a level of detail.
import { formatView, parseView, type View } from "./view.ts";

export const kFormats = ["glb", "ply", "obj", "stl", "drc"] as const;
export type Amount = { level: "lowest" | "highest" } | { triangles: number };

/** An element with an id has a view of its own in the page's fragment. */
function key(id: string): string {
  return id ? `view-${id}` : "view";
}

/** `page` with the view in its fragment; what else stands there remains. */
export function linkTo(page: string, id: string, view: View): string {
  const url = new URL(page), words = new URLSearchParams(url.hash.slice(1));
  words.set(key(id), formatView(view));
  url.hash = words.toString().replaceAll("%2C", ",");
  return url.href;
}

export function viewIn(fragment: string, id: string): View | undefined {
  return parseView(new URLSearchParams(fragment.replace(/^#/, "")).get(key(id)) ?? "");
}

/** The daemon's address of a model that is named by its page or by its API; undefined for a bare file. */
export function apiOf(src: string): string | undefined {
  const model = /^(.*?)\/(?:api\/v1\/)?models\/([^/.]+)\/?$/.exec(new URL(src).pathname);
  return model ? `${new URL(src).origin}${model[1]}/api/v1/models/${model[2]}` : undefined;
}

export function exportOf(api: string, format: string, amount: Amount): string {
  const [[name, value] = []] = Object.entries(amount);
  return `${api}/export.${format}?${name}=${value}`;
}
