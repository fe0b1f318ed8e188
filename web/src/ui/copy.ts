// SPDX-License-Identifier: Apache-2.0
import { h } from "./dom.ts";
import { texts } from "./texts/index.ts";

/** Creates a read-only text field with a button that copies its text. */
export function copyable(label: string, text: string): HTMLElement {
  const field = h("textarea", { readonly: true, rows: text.split("\n").length, spellcheck: "false", "aria-label": label }, text);
  const said = h("span", { role: "status", class: "quiet" });
  const copy = async () => {
    said.textContent = (await isCopied(field)) ? texts.copied : texts.copyByHand;
  };
  return h("div", { class: "copyable" }, field, h("p", {}, h("button", { type: "button", onclick: () => void copy() }, texts.copy), said));
}

/** Selects the text and copies it. Returns false if the browser refuses, for example because the page has no TLS. */
async function isCopied(field: HTMLTextAreaElement): Promise<boolean> {
  field.select();
  try {
    await navigator.clipboard.writeText(field.value);
    return true;
  } catch {
    return false;
  }
}
