// SPDX-License-Identifier: Apache-2.0
// Reports to the model's daemon that the model was visited: how long it was visible, and the finest level shown. A report contains
// nothing else. No report is sent for a .pmesh file or for a model that needs a token. No report is sent either if the daemon does
// not count visits, or if the browser says that the visitor does not want to be tracked.
import type { Stage } from "../stage.ts";
import type { Bench, Tool } from "./bench.ts";
import { apiOf } from "./links.ts";

/** Longest time, in seconds, that the daemon accepts in one report. */
const kMaxSeconds = 86_400;

/** One visit: the time in which the model was visible, and the finest level shown. Times are in milliseconds. */
export class Visit {
  #visible = 0; // visible time that has not been reported yet
  #since: number | undefined; // time since which the model has been visible; undefined if it is hidden
  #wasSeen = false;
  #level = 0;
  #reported: number | undefined; // level in the last report

  /** Called when the model has come into view, or left it, at the time `now`. */
  show(isVisible: boolean, now: number): void {
    if (this.#since !== undefined) this.#visible += now - this.#since;
    this.#since = isVisible ? now : undefined;
    this.#wasSeen ||= isVisible;
  }

  reach(level: number): void {
    this.#level = Math.max(this.#level, level);
  }

  /** Returns the query of a report about all that happened since the last report. Returns undefined if there is nothing to report. */
  report(now: number): string | undefined {
    this.show(this.#since !== undefined, now);
    const seconds = Math.min(Math.floor(this.#visible / 1000), kMaxSeconds), previous = this.#reported;
    if (!this.#wasSeen || (seconds === 0 && previous === this.#level)) return undefined;
    this.#visible -= 1000 * seconds;
    this.#reported = this.#level;
    return `seconds=${seconds}&level=${this.#level}${previous === undefined ? "" : `&previous=${previous}`}`;
  }
}

// A new toolbox, such as one in another language, continues the visit of the model on the stage.
const kVisits = new WeakMap<Stage, Visit>();

export class Visits implements Tool {
  #api: string | undefined; // the URL of the model if its daemon counts visits
  #stage: Stage | undefined;
  #isInView = false;
  #isAway = false; // whether the last visitor of a kiosk has left

  constructor(private readonly bench: Bench) {}

  attach(until: AbortSignal): void {
    this.#stage = undefined;
    this.#isInView = this.#isAway = false;
    const { host, stage } = this.bench, api = apiOf(new URL(host.getAttribute("src") ?? "", document.baseURI).href);
    if (api === undefined || host.token !== "" || isUnwanted()) return;
    this.#stage = stage;
    if (!kVisits.has(stage)) kVisits.set(stage, new Visit());
    const seen = new IntersectionObserver((entries) => {
      this.#isInView = entries.at(-1)?.isIntersecting ?? false;
      this.#look();
    });
    seen.observe(host);
    const options = { signal: until, passive: true, capture: true };
    document.addEventListener("visibilitychange", () => this.#look(), options);
    addEventListener("pagehide", () => this.#send(), options);
    host.addEventListener("refine", () => this.#reach(), options);
    for (const sign of ["pointerdown", "wheel", "keydown"]) host.addEventListener(sign, () => this.#return(), options);
    until.addEventListener("abort", () => {
      seen.disconnect();
      this.#send();
      this.#api = undefined;
    });
    this.#reach();
    // Ignores an error: visits are then not counted.
    void countsVisits(api, until).then((yes) => yes && !until.aborted && (this.#api = api)).catch(() => undefined);
  }

  /**
   * Ends the visit, because a kiosk had no input for some time. The next input begins another visit.
   */
  leave(): void {
    if (!this.#stage) return;
    this.#send();
    this.#isAway = true;
    kVisits.set(this.#stage, new Visit());
  }

  #return(): void {
    this.#isAway = false;
    this.#reach();
    this.#look();
  }

  get #visit(): Visit | undefined {
    return this.#stage && kVisits.get(this.#stage);
  }

  #reach(): void {
    const { stage, triangles } = this.bench, { levels } = stage.mesh.info;
    this.#visit?.reach(Math.max(levels.filter(({ faces }) => faces <= triangles).length - 1, 0));
  }

  /**
   * Updates the visit when the page or the model becomes visible or hidden. A hidden page may be
   * closed without another event, so its visit is reported at once.
   */
  #look(): void {
    const isHidden = document.visibilityState === "hidden";
    this.#visit?.show(this.#isInView && !isHidden && !this.#isAway, performance.now());
    if (isHidden) this.#send();
  }

  #send(): void {
    const query = this.#api && this.#visit?.report(performance.now());
    if (query) fetch(`${this.#api}/visits?${query}`, { method: "POST", mode: "no-cors", keepalive: true, referrerPolicy: "no-referrer" }).catch(() => undefined);
  }
}

/** Whether the browser says that its user does not want to be tracked (Global Privacy Control, or the older Do Not Track). */
function isUnwanted(): boolean {
  const { doNotTrack, globalPrivacyControl } = navigator as Navigator & { globalPrivacyControl?: boolean };
  return doNotTrack === "1" || globalPrivacyControl === true;
}

async function countsVisits(api: string, signal: AbortSignal): Promise<boolean> {
  const answer = await fetch(api, { signal, priority: "low" } as RequestInit);
  const { links } = (await answer.json()) as { links?: { visits?: string } };
  return links?.visits !== undefined;
}
