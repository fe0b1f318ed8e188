// SPDX-License-Identifier: Apache-2.0
// The services that every page of the console uses.
import type { Api } from "./api.ts";
import type { LiveJobs } from "./live-jobs.ts";
import type { Uploads } from "./uploads.ts";

export interface Desk {
  api: Api;
  jobs: LiveJobs;
  uploads: Uploads;
  /** Shows a message. Screen readers announce it without interrupting. */
  say(text: string): void;
}

export interface Visit {
  desk: Desk;
  /** The element that the page fills. */
  view: HTMLElement;
  /** Aborted when the operator goes to another page. */
  signal: AbortSignal;
  /** The parameters in the URL's fragment. */
  words: string[];
}

/** Fills the view and returns the page's title, which is also its heading. */
export type ConsolePage = (visit: Visit) => Promise<string> | string;

/** Resolves after `milliseconds`. Rejects if the operator leaves the page first. */
export function pause(milliseconds: number, signal: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const leave = () => (clearTimeout(timer), reject(signal.reason));
    const timer = setTimeout(() => (signal.removeEventListener("abort", leave), resolve()), milliseconds);
    signal.addEventListener("abort", leave, { once: true });
  });
}
