// SPDX-License-Identifier: Apache-2.0
// The page "/models/{id}": one object. The viewer starts at once; all that is said of it follows.
import { about } from "./about.ts";
import { model } from "./api.ts";
import { byId } from "./dom.ts";
import { language, texts } from "./texts/index.ts";

const id = decodeURIComponent(location.pathname.split("/").filter(Boolean).pop() ?? "");
const viewer = document.querySelector("progressive-mesh") as HTMLElement;
const title = byId("title"), aside = byId("about");

document.documentElement.lang = language;
byId("back").textContent = texts.collection;
byId("down").textContent = texts.about;
// In a frame of another site there is the object alone.
document.body.classList.toggle("framed", window.parent !== window);
// A link may name the way the bytes take: ?transport=ws.
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
