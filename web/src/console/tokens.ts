// SPDX-License-Identifier: Apache-2.0
// The page "#/tokens": who may call, for administrators.
import { copyable } from "../gallery/copy.ts";
import { h } from "../gallery/dom.ts";
import { date } from "../gallery/texts/index.ts";
import type { Page } from "./desk.ts";
import { Alert, button, confirmed, field, form } from "./forms.ts";
import { heading, paged } from "./parts.ts";
import { texts } from "./texts/index.ts";
import type { Role, Token } from "./types.ts";

const words = texts.tokens;

interface TokenPage {
  tokens: Token[];
  next: string | null;
}

export const tokensPage: Page = async ({ desk, view, signal }) => {
  const list = h("ul", { class: "cards" }), made = h("div", { "aria-live": "polite" });
  const fill = () => paged(list, async (cursor) => {
    const { tokens, next } = await desk.api.get<TokenPage>(`/tokens${cursor ? `?cursor=${cursor}` : ""}`, signal);
    return { rows: tokens.map(card), next };
  });

  function card({ id, role, label, created }: Token): HTMLElement {
    const alert = new Alert();
    const revoke = async () => {
      if (!(await confirmed(words.revokeQuestion(label || id), words.revokeExplanation, words.revoke))) return;
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
