// SPDX-License-Identifier: Apache-2.0
// The page "#/tokens": access tokens, for administrators.
import { copyable } from "../ui/copy.ts";
import { h } from "../ui/dom.ts";
import { date } from "../ui/texts/index.ts";
import type { ConsolePage } from "./desk.ts";
import { Alert, button, field, form, isConfirmed } from "./forms.ts";
import { heading, paged } from "./parts.ts";
import { texts } from "./texts/index.ts";
import type { Role, Token } from "./types.ts";

const words = texts.tokens;

interface TokenListPage {
  tokens: Token[];
  next: string | null;
}

export const tokensPage: ConsolePage = async ({ desk, view, signal }) => {
  const list = h("ul", { class: "cards" }), made = h("div", { "aria-live": "polite" });
  const fill = () => paged(list, async (cursor) => {
    const { tokens, next } = await desk.api.get<TokenListPage>(`/tokens${cursor ? `?cursor=${cursor}` : ""}`, signal);
    return { rows: tokens.map(card), next };
  });

  function card({ id, role, label, created }: Token): HTMLElement {
    const alert = new Alert();
    const revoke = async () => {
      if (!(await isConfirmed(words.revokeQuestion(label || id), words.revokeExplanation, words.revoke))) return;
      await desk.api.send("DELETE", `/tokens/${id}`);
      await fill();
      desk.say(words.revoked);
    };
    return h("li", { class: "card" },
      h("p", { class: "row" }, h("strong", {}, label || words.unnamed), h("span", { class: "quiet" }, `${texts.roles[role]} · ${date(created)}`)),
      h("div", { class: "actions" }, button(words.revoke, alert, revoke)), alert.element);
  }

  async function make(order: { role?: Role; label?: string }): Promise<void> {
    const { token } = await desk.api.send<Token & { token: string }>("POST", "/tokens", order);
    made.replaceChildren(h("div", { class: "card" }, h("p", {}, words.once), copyable(words.token, token)));
    await fill();
  }

  const roles = (["viewer", "operator", "admin"] as const).map((role): [string, string] => [role, texts.roles[role]]);
  view.append(heading(words.title), h("div", { class: "columns" },
    h("section", {}, list),
    h("section", { class: "card" }, h("h2", {}, words.make),
      form([field({ name: "label", label: words.label, hint: words.labelHint }), field({ name: "role", label: words.role, options: roles, value: "operator" })], words.make, make), made)));
  await fill();
  return words.title;
};
