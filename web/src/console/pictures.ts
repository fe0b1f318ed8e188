// SPDX-License-Identifier: Apache-2.0
// Images that need a token. Scripts fetch these images, because an <img> element cannot send a
// token.
import { h } from "../ui/dom.ts";
import type { Api } from "./api.ts";

/**
 * Creates an image that reserves its space, and is loaded when it becomes visible. Hides the image
 * if loading fails.
 */
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

/** Replaces the image's picture. Resolves when the new picture is decoded. */
export async function show(image: HTMLImageElement, blob: Blob): Promise<void> {
  const url = URL.createObjectURL(blob);
  image.src = url;
  try {
    await image.decode();
  } finally {
    URL.revokeObjectURL(url);
  }
}
