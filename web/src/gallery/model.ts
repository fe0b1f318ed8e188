// SPDX-License-Identifier: Apache-2.0
// The page "/models/{id}", which shows one object. The viewer and the description are loaded in parallel.
import { about } from "../ui/about.ts";
import { model } from "../ui/api.ts";
import { byId } from "../ui/dom.ts";
import { language, texts } from "../ui/texts/index.ts";

const id = decodeURIComponent(location.pathname.split("/").filter(Boolean).pop() ?? "");
const viewer = document.querySelector("progressive-mesh") as HTMLElement;
const title = byId("title"), aside = byId("about");

document.documentElement.lang = language;
byId("back").textContent = texts.collection;
byId("down").textContent = texts.about;
// In an iframe of another site, only the object is shown.
document.body.classList.toggle("framed", window.parent !== window);
// A link may choose the transport: ?transport=ws.
viewer.setAttribute("transport", new URLSearchParams(location.search).get("transport") ?? "auto");
viewer.setAttribute("src", `/api/v1/models/${encodeURIComponent(id)}`);

model(id)
  .then((record) => {
    document.title = title.textContent = record.title || texts.untitled;
    byId("credit").textContent = [record.creator, record.licence].filter(Boolean).join(" · ");
    viewer.setAttribute("alt", title.textContent);
    aside.append(...about(record));
    aside.hidden = byId("down").hidden = false;
  })
  .catch(() => (title.textContent = texts.notOnDisplay));
