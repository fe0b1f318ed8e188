// SPDX-License-Identifier: Apache-2.0
// The page "/console" for operators. The URL's fragment selects the page shown. All data come from
// the daemon's API.
import { byId, h } from "../ui/dom.ts";
import { Api } from "./api.ts";
import { calibratePage } from "./calibrate.ts";
import type { ConsolePage, Desk } from "./desk.ts";
import { forgetAllDrafts, isUnsaved } from "./drafts.ts";
import { Alert, isConfirmed } from "./forms.ts";
import { jobsPage } from "./jobs.ts";
import { LiveJobs } from "./live-jobs.ts";
import { modelPage } from "./model.ts";
import { modelsPage } from "./models.ts";
import { Problem } from "./problem.ts";
import { routed } from "./router.ts";
import { scanPage } from "./scan.ts";
import { scannerPage } from "./scanner.ts";
import { scannersPage } from "./scanners.ts";
import { newScanPage, scansPage } from "./scans.ts";
import { forgetToken, keptToken, signedIn } from "./sign-in.ts";
import { ScannerWatch } from "./scanner-watch.ts";
import { EmergencyStop } from "./stop.ts";
import { language, texts } from "./texts/index.ts";
import { tokensPage } from "./tokens.ts";
import { Uploads } from "./uploads.ts";
import { visitsPage } from "./visits.ts";

const kHome = "#/models";
const kPages: readonly (readonly [string, ConsolePage])[] = [
  ["models", modelsPage], ["models/:id", modelPage], ["jobs", jobsPage], ["visits", visitsPage], ["tokens", tokensPage],
  ["scanners", scannersPage], ["scanners/:name", scannerPage], ["scanners/:name/calibrate", calibratePage],
  ["scans", scansPage], ["scans/new", newScanPage], ["scans/new/:scanner", newScanPage], ["scans/:id", scanPage],
];

const main = byId("main"), nav = byId("nav"), said = byId("said"), top = byId("top");

function say(text: string): void {
  said.textContent = text;
  said.classList.remove("fresh");
  void said.offsetWidth; // forces a layout, which restarts the animation
  said.classList.add("fresh");
}

let visit = new AbortController();

/** Ends the previous page and shows the page that the URL's fragment selects. */
async function go(desk: Desk): Promise<void> {
  visit.abort();
  const { signal } = (visit = new AbortController());
  const found = routed(kPages, location.hash) ?? { target: modelsPage, words: [] };
  const view = h("div", { class: "view" });
  main.replaceChildren(view);
  for (const link of nav.querySelectorAll("a")) {
    if (location.hash.startsWith(link.hash)) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  try {
    const title = await found.target({ desk, view, signal, words: found.words });
    if (signal.aborted) return;
    document.title = `${title} · ${texts.title}`;
    view.querySelector<HTMLElement>("h1")?.focus({ preventScroll: true });
    scrollTo(0, 0);
  } catch (error) {
    if (signal.aborted) return;
    const alert = new Alert();
    alert.show(error);
    view.append(alert.element, h("p", {}, h("button", { type: "button", onclick: () => void go(desk) }, texts.tryAgain)));
  }
}

/** Whether the token has the role of an administrator. Only this role may list the tokens. */
async function isAdmin(api: Api): Promise<boolean> {
  try {
    await api.get("/tokens?limit=1");
    return true;
  } catch (error) {
    if (error instanceof Problem) return false;
    throw error;
  }
}

/** Resolves when the operator signs out with the button `leave`. If there are unsaved changes, the operator has to confirm. */
function signedOut(leave: HTMLButtonElement): Promise<undefined> {
  const { leaveQuestion, leaveExplanation, leaveNow } = texts.signIn;
  return new Promise((resolve) => leave.addEventListener("click", async () => {
    if (!isUnsaved() || (await isConfirmed(leaveQuestion, leaveExplanation, leaveNow))) resolve(undefined);
  }));
}

/** Shows the console until the operator signs out or the daemon rejects the token. Resolves to the daemon's error, if any. */
async function work(api: Api): Promise<unknown> {
  const end = new AbortController(), { signal } = end;
  const refused = new Promise((resolve) => (api.onRefused = resolve));
  const desk: Desk = { api, say, jobs: new LiveJobs(api), uploads: new Uploads(api.headers) };
  const watch = new ScannerWatch(api), stop = new EmergencyStop(api, watch);
  const leave = h("button", { type: "button", class: "plain" }, texts.signIn.leave);
  const pages = (["models", "scanners", "scans", "jobs", "visits"] as const).map((name) => h("a", { href: `#/${name}` }, texts[name].title));
  nav.replaceChildren(...pages);
  byId("tools").replaceChildren(leave, stop.button);
  top.append(watch.element, stop.said);
  void isAdmin(api).then((yes) => yes && nav.append(h("a", { href: "#/tokens" }, texts.tokens.title)), () => undefined);
  void watch.run(signal).catch(() => undefined);
  void desk.jobs.run(signal);
  addEventListener("hashchange", () => void go(desk), { signal });
  addEventListener("beforeunload", (event) => desk.uploads.isSending && event.preventDefault(), { signal });
  if (!routed(kPages, location.hash)) history.replaceState(null, "", kHome);
  void go(desk);
  const why = await Promise.race([refused, signedOut(leave)]);
  end.abort();
  visit.abort();
  nav.replaceChildren();
  byId("tools").replaceChildren();
  watch.element.remove();
  stop.said.remove();
  forgetToken();
  // After a rejected token, the same operator usually continues with a new one.
  if (!why) forgetAllDrafts();
  return why;
}

document.documentElement.lang = language;
document.title = texts.title;
byId("home").textContent = texts.title;
nav.setAttribute("aria-label", texts.navigation);
byId("gallery").textContent = texts.gallery;
for (let why: unknown, kept = keptToken(); ; kept = null) {
  document.title = texts.title;
  why = await work(kept ? new Api(kept) : await signedIn(main, why));
}
