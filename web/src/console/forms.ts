// SPDX-License-Identifier: Apache-2.0
// Form fields and buttons with error messages beside them. Each message names the field and the
// next step.
import { h } from "../ui/dom.ts";
import { Problem, type ParameterFault } from "./problem.ts";
import { texts } from "./texts/index.ts";

type Control = HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement;

export interface FieldOptions {
  name: string;
  label: string;
  hint?: string;
  value?: string | number | boolean | null | undefined;
  type?: "text" | "number" | "checkbox" | "textarea" | "date";
  options?: [value: string, label: string][];
  suggestions?: readonly [value: string, label: string][]; // the field accepts other texts, too
  min?: number;
  max?: number;
  step?: number | "any";
  required?: boolean;
}

/** An element that shows an error. It is hidden if there is no error. */
export class Alert {
  readonly element = h("div", { role: "alert", class: "alert", hidden: true });

  clear(): void {
    this.element.hidden = true;
    this.element.replaceChildren();
  }

  show(error: unknown, faults: ParameterFault[] = error instanceof Problem ? error.faults : []): void {
    const list = faults.map(({ parameter, detail }) => h("li", {}, h("code", {}, parameter), `: ${detail}`));
    const trace = error instanceof Problem && error.request ? h("p", { class: "quiet" }, texts.problem.request(error.request)) : null;
    this.element.replaceChildren(h("p", {}, sentence(error)), ...(list.length ? [h("ul", {}, ...list)] : []), ...(trace ? [trace] : []));
    this.element.hidden = false;
  }

  /** Runs `act`. If `act` fails, shows the error and returns false. */
  async attempt(act: () => Promise<unknown>): Promise<boolean> {
    this.clear();
    try {
      await act();
      return true;
    } catch (error) {
      this.show(error);
      return false;
    }
  }
}

/** Describes an error for the operator: the fault and the next step. */
export function sentence(error: unknown): string {
  const words = texts.problem;
  if (error instanceof DOMException) return error.name === "TimeoutError" ? words.silent : words.interrupted;
  if (error instanceof TypeError) return words.silent;
  if (!(error instanceof Problem)) return String((error as Error).message);
  if (error.detail) return capital(error.detail);
  if (error.status === 0) return words.silent;
  return error.status >= 500 ? words.failed : words.refused(error.status, error.title);
}

const capital = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

/**
 * Creates a button that runs `act` when clicked, and is disabled until `act` is done. If `act`
 * fails, `alert` shows the error.
 */
export function button(label: string, alert: Alert, act: () => Promise<unknown>, kind = ""): HTMLButtonElement {
  const made = h("button", { type: "button", class: kind }, label);
  made.addEventListener("click", async () => {
    made.disabled = true;
    await alert.attempt(act);
    made.disabled = false;
  });
  return made;
}

let fields = 0;

/** Creates a form field with its label, and an element below that shows the hint or an error. */
export function field({ name, label, hint, value, type = "text", options, suggestions, min, max, step, required }: FieldOptions): HTMLElement {
  const id = `field-${++fields}`;
  const shared = { id, name, required, "aria-describedby": `${id}-note` };
  const control = options
    ? h("select", shared, ...options.map(([key, text]) => h("option", { value: key, selected: key === String(value ?? "") }, text)))
    : type === "textarea"
      ? h("textarea", { ...shared, rows: 4 }, String(value ?? ""))
      : type === "checkbox"
        ? h("input", { ...shared, type, checked: value === true })
        : h("input", { ...shared, type, value: value === null || value === undefined ? "" : String(value), min, max, step, autocomplete: "off", list: suggestions && `${id}-list` });
  const list = suggestions ? h("datalist", { id: `${id}-list` }, ...suggestions.map(([key, text]) => h("option", { value: key }, text))) : "";
  const note = h("small", { id: `${id}-note`, "data-hint": hint ?? "" }, hint);
  return h("div", { class: `field ${type}` }, h("label", { for: id }, label), control, list, note);
}

export type Values = Record<string, string | number | boolean | null>;

/**
 * Creates a form that passes its values to `act` when submitted. If `act` fails, shows the error with showFaults(), in `alert` below the
 * buttons.
 */
export function form(all: HTMLElement[], submit: string, act: (values: Values) => Promise<unknown>, kind = "", alert = new Alert()): HTMLFormElement {
  const send = h("button", { type: "submit", class: kind === "inline" ? "" : "primary" }, submit);
  const made = h("form", { class: `form ${kind}` }, ...all, h("div", { class: "actions" }, send), alert.element);
  made.addEventListener("submit", async (event) => {
    event.preventDefault();
    alert.clear();
    for (const control of controls(made)) mark(control, "");
    send.disabled = true;
    await act(values(made)).catch((error) => showFaults(error, alert, made));
    send.disabled = false;
  });
  return made;
}

/** Shows each fault of an error beside its field in the form `within`, and the rest in `alert`. Focuses the first of these fields. */
export function showFaults(error: unknown, alert: Alert, within: HTMLFormElement): void {
  alert.show(error, place(error, within));
  controls(within).find((control) => control.ariaInvalid === "true")?.focus();
}

function controls(within: HTMLFormElement): Control[] {
  return [...within.querySelectorAll<Control>("input, select, textarea")].filter(({ name }) => name !== "");
}

function values(within: HTMLFormElement): Values {
  return Object.fromEntries(controls(within).map((control) => [control.name, valueOf(control)]));
}

/** Returns the value of a field; null for an empty number field. */
function valueOf(control: Control): string | number | boolean | null {
  if (control.type === "checkbox") return (control as HTMLInputElement).checked;
  if (control.type === "number") return control.value === "" ? null : Number(control.value);
  return control.value.trim();
}

/**
 * Shows the faults of a problem beside the fields that they name ("metadata.title" names the field
 * "title"). Returns the faults that name no field.
 */
function place(error: unknown, within: HTMLFormElement): ParameterFault[] {
  if (!(error instanceof Problem)) return [];
  return error.faults.filter(({ parameter, detail }) => {
    const control = controls(within).find(({ name }) => name === parameter.split(".").pop());
    if (control) mark(control, detail);
    return !control;
  });
}

function mark(control: Control, fault: string): void {
  control.toggleAttribute("aria-invalid", fault !== "");
  if (fault) control.setAttribute("aria-invalid", "true");
  const note = document.getElementById(`${control.id}-note`);
  if (note) note.textContent = fault ? texts.problem.expected(fault) : (note.dataset["hint"] ?? "");
}

/**
 * Asks the operator to confirm an action that cannot be undone. Resolves to true if the operator
 * confirms. The button that cancels has the focus at first.
 */
export function isConfirmed(question: string, explanation: string, yes: string): Promise<boolean> {
  const no = h("button", { value: "", autofocus: true }, texts.cancel);
  const dialog = h("dialog", { "aria-labelledby": "question" },
    h("form", { method: "dialog" }, h("h2", { id: "question" }, question), h("p", {}, explanation),
      h("div", { class: "actions" }, no, h("button", { value: "yes", class: "danger" }, yes))));
  document.body.append(dialog);
  dialog.showModal();
  return new Promise((resolve) => dialog.addEventListener("close", () => {
    dialog.remove();
    resolve(dialog.returnValue === "yes");
  }));
}
