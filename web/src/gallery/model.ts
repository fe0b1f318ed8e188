// SPDX-License-Identifier: Apache-2.0
// The page "/models/{id}": one object. The viewer starts at once; title and credit follow.
import { texts } from "../texts.ts";
import { model } from "./api.ts";

const id = decodeURIComponent(location.pathname.split("/").filter(Boolean).pop() ?? "");
const viewer = document.querySelector("progressive-mesh") as HTMLElement;
const title = document.getElementById("title") as HTMLElement;
const credit = document.getElementById("credit") as HTMLElement;

(document.getElementById("back") as HTMLElement).textContent = texts.back;
// A link may name the way the bytes take: ?transport=ws.
viewer.setAttribute("transport", new URLSearchParams(location.search).get("transport") ?? "auto");
viewer.setAttribute("src", `/api/v1/models/${encodeURIComponent(id)}`);

model(id)
  .then((record) => {
    document.title = title.textContent = record.title || texts.untitled;
    credit.textContent = [record.creator, record.licence].filter(Boolean).join(" · ");
    viewer.setAttribute("alt", title.textContent);
  })
  .catch(() => (title.textContent = texts.modelFailed));
