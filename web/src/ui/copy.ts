// SPDX-License-Identifier: Apache-2.0
import { h } from "./dom.ts";
import { texts } from "./texts/index.ts";

/** Creates a read-only text field with a button that copies its text. */
export function copyable(label: string, text: string): HTMLElement {
  const field = h("textarea", { readonly: true, rows: text.split("\n").length, spellcheck: "false", "aria-label": label }, text);
  return h("div", { class: "copyable" }, field, copier(text, () => field.select()));
}

/** Creates a paragraph with a button that copies its text. `label` describes the text to screen readers, with the button. */
export function quotable(label: string, text: string): HTMLElement {
  const quote = h("p", { dir: "auto" }, text);
  return h("div", { class: "quotable" }, quote, copier(text, () => getSelection()?.selectAllChildren(quote), `${texts.copy}: ${label}`));
}

/** Creates a button that selects a text by `select` and copies it. */
function copier(text: string, select: () => void, label?: string): HTMLElement {
  const said = h("span", { role: "status", class: "quiet" });
  const copy = async () => {
    select();
    said.textContent = (await isCopied(text)) ? texts.copied : texts.copyByHand;
  };
  return h("p", { class: "copier" }, h("button", { type: "button", "aria-label": label, onclick: () => void copy() }, texts.copy), said);
}

/** Copies the text. Returns false if the browser refuses, for example because the page has no TLS. */
async function isCopied(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}
