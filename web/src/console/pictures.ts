// SPDX-License-Identifier: Apache-2.0
// Pictures that are shown to whoever sends a token: an <img> sends none.
import { h } from "../gallery/dom.ts";
import type { Api } from "./api.ts";

/** An image that takes its place at once and fills it when it has come; without it there is none. */
export function picture(api: Api, path: string, alt: string, signal: AbortSignal): HTMLImageElement {
  const image = h("img", { alt, class: "pending" });
  const seen = new IntersectionObserver(([entry]) => {
    if (!entry?.isIntersecting) return;
    seen.disconnect();
    void fill(image, api, path, signal);
  });
  seen.observe(image);
  return image;
}

async function fill(image: HTMLImageElement, api: Api, path: string, signal: AbortSignal): Promise<void> {
  try {
    await show(image, await api.blob(path, signal));
    image.classList.remove("pending");
  } catch {
    image.classList.add("missing");
  }
}

/** In the place of what it shows now; resolves when it is on the screen. */
export async function show(image: HTMLImageElement, blob: Blob): Promise<void> {
  const url = URL.createObjectURL(blob);
  image.src = url;
  try {
    await image.decode();
  } finally {
    URL.revokeObjectURL(url);
  }
}
