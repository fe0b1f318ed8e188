// SPDX-License-Identifier: Apache-2.0
// The texts of the visitors' pages. The language is the first of the browser's preferred languages
// for which there are texts.
import { formats } from "../../texts/formats.ts";
import { de } from "./de.ts";
import { en } from "./en.ts";
import { es } from "./es.ts";
import { fr } from "./fr.ts";
import { it } from "./it.ts";

const all = { en, de, es, fr, it };
export type Language = keyof typeof all;

const isKnown = (name: string): name is Language => name in all;
/** Language of the visitors' pages. */
export const language: Language = (globalThis.navigator?.languages ?? []).map((tag) => tag.slice(0, 2).toLowerCase()).find(isKnown) ?? "en";

export const texts = all[language];

const precise = new Intl.NumberFormat(language, { maximumSignificantDigits: 3 });
const day = new Intl.DateTimeFormat(language, { dateStyle: "medium" });
const moment = new Intl.DateTimeFormat(language, { dateStyle: "medium", timeStyle: "short" });

const second = new Intl.DateTimeFormat(language, { timeStyle: "medium" });

export const { count, size } = formats(language);
/** Formats a number with three significant digits. */
export const measure = (value: number): string => precise.format(value);
export const date = (stamp: string): string => day.format(new Date(stamp));
/** Formats the time of day with seconds. */
export const clock = (stamp: string): string => second.format(new Date(stamp));
export const time = (stamp: string): string => moment.format(new Date(stamp));

/** Describes a remaining time in words. The time is rounded, because it is an estimate. */
export function timeLeft(seconds: number): string {
  const { left } = texts, minutes = Math.round(seconds / 60), hours = Math.round(seconds / 3600);
  if (seconds < 10) return left.seconds;
  if (seconds < 45) return left.halfAMinute;
  if (minutes <= 1) return left.aMinute;
  if (minutes < 60) return left.minutes(minutes);
  return hours <= 1 ? left.anHour : left.hours(hours);
}

/** Returns a text for the state of a scan. If known, the text says why the scan failed or what it is waiting for. */
export function scanState({ state, error, note }: { state: keyof typeof texts.scan.states; error: string | null; note: string | null }): string {
  const why = error ?? note;
  return why === null ? texts.scan.states[state] : `${texts.scan.states[state]}: ${why}`;
}
