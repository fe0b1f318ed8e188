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
// In an iframe of another site, shows only the object, leaves vertical swipes to that site's page, and opens the collection, which
// no frame may show, in a tab of its own.
const isFramed = window.parent !== window;
document.body.classList.toggle("framed", isFramed);
if (isFramed) {
  viewer.setAttribute("touch-action", "pan-y");
  byId<HTMLAnchorElement>("back").target = "_blank";
}
// A link can choose the transport, for example with ?transport=ws.
viewer.setAttribute("transport", new URLSearchParams(location.search).get("transport") ?? "auto");
viewer.toggleAttribute("ar", true);
viewer.setAttribute("src", `/api/v1/models/${encodeURIComponent(id)}`);

const showPoster = (width: number) => viewer.setAttribute("poster", `/api/v1/models/${encodeURIComponent(id)}/poster.png?width=${width}`);
// Shows the poster if the object cannot be drawn. On a slow line, shows a small poster until the object is drawn. On faster
// lines, a poster would only delay the object.
viewer.addEventListener("error", () => showPoster(960), { once: true });
if (isSlow()) showPoster(240);

model(id)
  .then((record) => {
    document.title = title.textContent = record.title || texts.untitled;
    byId("credit").textContent = [record.creator, record.licence].filter(Boolean).join(" · ");
    viewer.setAttribute("alt", title.textContent);
    aside.replaceChildren(...about(record));
    byId("down").hidden = false;
  })
  .catch(() => (title.textContent = texts.notOnDisplay));

/**
 * Whether the browser reports a line that is slower than most mobile lines. Not all browsers report this.
 */
function isSlow(): boolean {
  const { connection } = navigator as { connection?: { effectiveType?: string } };
  return !["4g", undefined].includes(connection?.effectiveType);
}
