// SPDX-License-Identifier: Apache-2.0
import { h } from "./dom.ts";
import { texts } from "./texts/index.ts";

/** A text to be taken along, with a button that copies it. */
export function copyable(label: string, text: string): HTMLElement {
  const field = h("textarea", { readonly: true, rows: text.split("\n").length, spellcheck: "false", "aria-label": label }, text);
  const said = h("span", { role: "status", class: "quiet" });
  const copy = async () => {
    said.textContent = (await copied(field)) ? texts.copied : texts.copyByHand;
  };
  return h("div", { class: "copyable" }, field, h("p", {}, h("button", { type: "button", onclick: () => void copy() }, texts.copy), said));
}

/** Pages without TLS may not write to the clipboard: then the text is selected. */
async function copied(field: HTMLTextAreaElement): Promise<boolean> {
  field.select();
  try {
    await navigator.clipboard.writeText(field.value);
    return true;
  } catch {
    return false;
  }
}
