// SPDX-License-Identifier: Apache-2.0
// What every page of the console works with.
import type { Api } from "./api.ts";
import type { LiveJobs } from "./live-jobs.ts";
import type { Uploads } from "./uploads.ts";

export interface Desk {
  api: Api;
  jobs: LiveJobs;
  uploads: Uploads;
  /** Says politely what has happened, to those who do not see it, too. */
  say(text: string): void;
}

export interface Visit {
  desk: Desk;
  /** To be filled. */
  view: HTMLElement;
  /** Ends when the operator goes to another page. */
  signal: AbortSignal;
  /** Out of the address. */
  words: string[];
}

/** Fills the view; resolves to the page's title, which is its heading, too. */
export type Page = (visit: Visit) => Promise<string> | string;

/** Resolves after `milliseconds`; rejects where the visit ends before. */
export function pause(milliseconds: number, signal: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const leave = () => (clearTimeout(timer), reject(signal.reason));
    const timer = setTimeout(() => (signal.removeEventListener("abort", leave), resolve()), milliseconds);
    signal.addEventListener("abort", leave, { once: true });
  });
}
