// SPDX-License-Identifier: Apache-2.0
type AttributeValues = Record<string, string | boolean | EventListener>;

/** Creates an element. Functions become listeners ("onclick"), booleans set or omit an attribute, strings are attribute values. */
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

/** Creates a radio group called `name`; the first value is selected initially. */
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
