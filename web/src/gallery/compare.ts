// SPDX-License-Identifier: Apache-2.0
// The page "/compare.html?left=ID&right=ID", which shows two objects side by side or one over the other, with coupled cameras.
import { model, models, type ModelRecord } from "../ui/api.ts";
import { Coupling, type Viewer } from "./coupling.ts";
import { byId, h } from "../ui/dom.ts";
import { language, texts } from "../ui/texts/index.ts";

type Side = "left" | "right";
const kSides = ["left", "right"] as const;

const pair = byId("pair"), mode = byId("mode"), query = new URLSearchParams(location.search);
const wipe = h("input", { type: "range", min: 0, max: 100, value: 50, hidden: true, "aria-label": texts.compare.wipeAt });
const coupling = new Coupling();

function side(name: Side, all: readonly ModelRecord[]): HTMLElement {
  const viewer = document.createElement("progressive-mesh") as HTMLElement as Viewer;
  viewer.setAttribute("camera-controls", "");
  viewer.setAttribute("touch-action", "none");
  const options = all.map(({ id, title }) => h("option", { value: id }, title || texts.untitled));
  const select = h("select", { "aria-label": texts.compare[name] }, ...options);
  const show = () => {
    const chosen = all.find(({ id }) => id === select.value);
    if (!chosen) return;
    coupling.set(viewer, chosen.unit);
    viewer.setAttribute("alt", chosen.title || texts.untitled);
    viewer.setAttribute("src", `/api/v1/models/${encodeURIComponent(chosen.id)}`);
    query.set(name, chosen.id);
    history.replaceState(null, "", `?${query}`);
  };
  select.value = query.get(name) ?? all[name === "left" ? 0 : 1]?.id ?? "";
  select.addEventListener("change", show);
  show();
  return h("section", { class: name }, select, viewer);
}

/** Returns the newest objects, and the objects that the page's URL names. */
async function listed(): Promise<ModelRecord[]> {
  const { models: newest } = await models("", null);
  const named = kSides.flatMap((name) => query.get(name) ?? []).filter((id) => !newest.some((record) => record.id === id));
  return [...newest, ...(await Promise.all(named.map(model)))];
}

function lay(isWiped: boolean): void {
  pair.classList.toggle("wiped", isWiped);
  mode.ariaPressed = String(isWiped);
  wipe.hidden = !isWiped;
}

document.documentElement.lang = language;
document.title = byId("title").textContent = texts.compare.title;
byId("back").textContent = texts.collection;
mode.textContent = texts.compare.wipe;
mode.addEventListener("click", () => lay(mode.ariaPressed === "false"));
wipe.addEventListener("input", () => pair.style.setProperty("--wipe", `${wipe.value}%`));
listed().then((all) => pair.append(...kSides.map((name) => side(name, all)), wipe)).catch(() => (byId("note").textContent = texts.unreachable));
