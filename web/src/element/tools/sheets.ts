// SPDX-License-Identifier: Apache-2.0
// The toolbar, and the sheets that its buttons open. At most one sheet is open.
import { make } from "./dom.ts";
import { icon, type Icon } from "./icons.ts";

interface Sheet {
  button: HTMLButtonElement;
  element: HTMLElement;
  onOpen: (open: boolean) => void;
}

export class Sheets {
  readonly #sheets: Sheet[] = [];

  constructor(private readonly bar: HTMLElement, private readonly closeLabel: string) {
    bar.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.#open) return;
      event.stopPropagation(); // without this, Escape would also close a dialog of the page
      const { button } = this.#open;
      this.close();
      button.focus();
    });
  }

  /** Adds a button that calls `act` when it is clicked. */
  action(name: Icon, label: string, act: () => void): HTMLButtonElement {
    const shown = [icon(name), make("span", {}, label)];
    const button = make("button", { type: "button", name, title: label, "aria-label": label, onclick: act }, ...shown);
    this.bar.append(button);
    return button;
  }

  /** Adds a button that opens and closes a sheet with `content`. */
  add(name: Icon, label: string, content: HTMLElement, onOpen: (open: boolean) => void = () => undefined): HTMLButtonElement {
    const button = this.action(name, label, () => this.#toggle(sheet));
    const leave = () => (this.close(), button.focus());
    const close = make("button", { type: "button", class: "close", "aria-label": this.closeLabel, onclick: leave }, icon("close"));
    const element = make("section", { class: "sheet", role: "group", "aria-label": label, hidden: true },
      make("header", {}, make("p", {}, label), close), content);
    const sheet = { button, element, onOpen };
    button.ariaExpanded = "false";
    this.#sheets.push(sheet);
    button.after(element);
    return button;
  }

  close(): void {
    if (this.#open) this.#toggle(this.#open);
  }

  get #open(): Sheet | undefined {
    return this.#sheets.find(({ element }) => !element.hidden);
  }

  #toggle(sheet: Sheet): void {
    const open = sheet.element.hidden;
    if (open) this.close();
    sheet.element.hidden = !open;
    sheet.button.ariaExpanded = String(open);
    sheet.onOpen(open);
  }
}
