// SPDX-License-Identifier: Apache-2.0
// Links that a visitor can share: to what the viewer shows now, and to files of the model at a level
// of detail.

export const kFormats = ["glb", "ply", "obj", "stl", "drc", "wrl", "3mf", "usdz"] as const;
export type ExportDetail = { level: "lowest" | "highest" } | { triangles: number };

/** Returns the key of an element's setting in the URL fragment. Each element with an ID has keys of its own. */
function key(name: string, id: string): string {
  return id ? `${name}-${id}` : name;
}

/**
 * Returns the URL `page` with an element's settings in its fragment. Leaves out empty settings. Keeps the other keys of the
 * fragment.
 */
export function linkTo(page: string, id: string, settings: Record<string, string>): string {
  const url = new URL(page), words = new URLSearchParams(url.hash.slice(1));
  for (const [name, value] of Object.entries(settings)) {
    if (value) words.set(key(name, id), value);
    else words.delete(key(name, id));
  }
  url.hash = words.toString().replaceAll("%2C", ",");
  return url.href;
}

/** Returns a setting of an element in a URL fragment. Returns an empty text if there is none. */
export function settingIn(fragment: string, id: string, name: string): string {
  return new URLSearchParams(fragment.replace(/^#/, "")).get(key(name, id)) ?? "";
}

/**
 * Returns the API URL of a model. `src` is the model's API URL or the URL of its page. Returns
 * undefined for a .pmesh file.
 */
export function apiOf(src: string): string | undefined {
  const model = /^(.*?)\/(?:api\/v1\/)?models\/([^/.]+)\/?$/.exec(new URL(src).pathname);
  return model ? `${new URL(src).origin}${model[1]}/api/v1/models/${model[2]}` : undefined;
}

export function exportOf(api: string, format: string, amount: ExportDetail): string {
  const [[name, value] = []] = Object.entries(amount);
  return `${api}/export.${format}?${name}=${value}`;
}
