// SPDX-License-Identifier: Apache-2.0
type AttributeValues = Record<string, string | boolean | EventListener>;

/**
 * Creates an element. In the attributes, functions become listeners ("onclick"), booleans set or
 * omit the attribute, and strings are values.
 */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: AttributeValues = {}, ...content: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else if (typeof value === "boolean") element.toggleAttribute(name, value);
    else element.setAttribute(name, value);
  }
  element.append(...content);
  return element;
}

/** Lets the browser save a file. */
export function save(content: Blob, name: string): void {
  const address = URL.createObjectURL(content);
  make("a", { href: address, download: name }).click();
  URL.revokeObjectURL(address);
}

/** Creates a radio group called `name`. Its first value is selected initially. */
export function choices<T extends string>(
  name: string, label: string, labels: Record<T, string>, chosen: (value: T) => void,
): HTMLElement {
  const options = (Object.entries(labels) as [T, string][]).map(([value, text], i) =>
    make("label", {}, make("input", { type: "radio", name, value, checked: i === 0, onchange: () => chosen(value) }), make("span", {}, text)));
  return make("div", { class: "choices", role: "radiogroup", "aria-label": label }, ...options);
}

export function checkbox(name: string, label: string, checked: boolean, changed: (on: boolean) => void): HTMLLabelElement {
  const box = make("input", { type: "checkbox", name, checked, onchange: () => changed(box.checked) });
  return make("label", { class: "check" }, box, make("span", {}, label));
}
