// SPDX-License-Identifier: Apache-2.0
// Functions that create and find elements. User input becomes text nodes or attribute values, never
// HTML.
type Child = Node | string | false | null | undefined;
type ElementAttributes = Record<string, string | number | boolean | ((event: Event) => void) | null | undefined>;

/**
 * Creates an element. In `attributes`, functions (`on…`) become listeners, and `true` becomes an
 * attribute without a value. Omits attributes and children that are null, undefined or false.
 */
export function h<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: ElementAttributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) made.setAttribute(name, value === true ? "" : String(value));
  }
  made.append(...children.filter((child): child is Node | string => child instanceof Node || Boolean(child)));
  return made;
}

export function byId<Type extends HTMLElement>(id: string): Type {
  return document.getElementById(id) as Type;
}

/**
 * Creates a square image that is loaded lazily. Its size is set in advance, so that the layout does
 * not shift. The image is removed if loading fails.
 */
export function square(src: string, side: number): HTMLImageElement {
  const image = h("img", { loading: "lazy", alt: "", width: side, height: side, src });
  image.addEventListener("error", () => image.remove());
  return image;
}
