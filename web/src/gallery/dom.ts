// SPDX-License-Identifier: Apache-2.0
// Elements in one expression. What somebody has written only ever becomes text.
type Child = Node | string | false | null | undefined;
type Attributes = Record<string, string | number | boolean | ((event: Event) => void) | null | undefined>;

/** `on…` are listeners, `true` is an attribute without a value; null and false are left out. */
export function h<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
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

/** Not wider than what holds it, in a size that a browser knows before it has come. */
export function square(src: string, side: number): HTMLImageElement {
  const image = h("img", { loading: "lazy", alt: "", width: side, height: side, src });
  image.addEventListener("error", () => image.remove());
  return image;
}
