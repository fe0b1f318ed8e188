// SPDX-License-Identifier: Apache-2.0
// Unsaved changes of the pages of models. They outlive the page that made them, because an operator may visit other pages before
// saving.
const all: Map<string, unknown>[] = [];

/** Creates a map of unsaved changes by the model's ID. While one of these maps has entries, the browser asks before it leaves the console. */
export function newDrafts<Draft>(): Map<string, Draft> {
  const made = new Map<string, Draft>();
  all.push(made);
  return made;
}

/** Discards all unsaved changes of a model. */
export function forgetDrafts(model: string): void {
  for (const drafts of all) drafts.delete(model);
}

/** Discards all unsaved changes, for example before another operator signs in. */
export function forgetAllDrafts(): void {
  for (const drafts of all) drafts.clear();
}

/** Whether there are unsaved changes of any model. */
export const isUnsaved = (): boolean => all.some(({ size }) => size > 0);

/** Asks the operator before the browser leaves the console, if there are unsaved changes. */
export function guardDrafts(): void {
  addEventListener("beforeunload", (event) => isUnsaved() && event.preventDefault());
}
