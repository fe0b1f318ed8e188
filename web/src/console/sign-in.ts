// SPDX-License-Identifier: Apache-2.0
// Signs an operator in. The token is kept in the session storage of the browser tab. The browser
// deletes that storage when the tab is closed.
import { h } from "../ui/dom.ts";
import { Api } from "./api.ts";
import { Alert, field } from "./forms.ts";
import { texts } from "./texts/index.ts";

const kKept = "vitrine.token";

export const keptToken = (): string | null => sessionStorage.getItem(kKept);
export const forgetToken = (): void => sessionStorage.removeItem(kKept);

/**
 * Asks for a token until the daemon accepts one. Resolves to an API client with that token. `why`
 * is the error that signed the operator out, if any. The page shows this error.
 */
export function signedIn(view: HTMLElement, why?: unknown): Promise<Api> {
  const alert = new Alert(), words = texts.signIn, token = field({ name: "token", label: words.token, hint: words.hint, required: true });
  const input = token.querySelector("input") as HTMLInputElement;
  input.type = "password";
  const form = h("form", { class: "sign-in" }, h("h1", {}, words.title), token,
    h("div", { class: "actions" }, h("button", { class: "primary" }, words.enter)), alert.element);
  view.replaceChildren(form);
  input.focus();
  if (why) alert.show(why);
  return new Promise((resolve) => form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const api = new Api(input.value.trim());
    const isKnown = await alert.attempt(() => api.get("/jobs?limit=1"));
    if (!isKnown) return input.select();
    sessionStorage.setItem(kKept, api.token);
    resolve(api);
  }));
}
