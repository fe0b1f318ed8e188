// SPDX-License-Identifier: Apache-2.0
// Checks the JSON of a file of notes, so that a malformed file does not break the editor. The daemon checks the rest when the notes
// are saved.
import type { StoredNote, StoredTour } from "../element/notes/annotations.ts";

interface Body {
  type?: string;
  id?: string;
  value?: string;
  language?: string;
}
interface Selector {
  type?: string;
  x?: number;
  y?: number;
  z?: number;
}
export interface IiifAnnotation {
  label?: Record<string, string[]>;
  body?: Body | Body[];
  target?: { selector?: Selector | Selector[] };
}

type Check = (value: unknown) => boolean;

const isText: Check = (value) => typeof value === "string";
const isNumber: Check = (value) => Number.isFinite(value);
const isPoint: Check = (value) => Array.isArray(value) && value.length === 3 && value.every(isNumber);
/** Accepts a missing value too. */
const maybe = (check: Check): Check => (value) => value === undefined || check(value);
const listOf = (check: Check): Check => (value) => Array.isArray(value) && value.every(check);
const oneOrMore = (check: Check): Check => (value) => check(value) || listOf(check)(value);
/** Accepts objects with at least `least` members that all pass `check`. */
const mapOf = (check: Check, least: number): Check => (value) => isObject(value) && Object.keys(value).length >= least && Object.values(value).every(check);
const objectOf = (members: Record<string, Check>): Check => (value) => isObject(value) && Object.entries(members).every(([name, check]) => check(value[name]));

const isTextOfNote = objectOf({ title: isText, text: maybe(isText), alt: maybe(isText), audio: maybe(isText) });
const isView = objectOf({ direction: isPoint, target: maybe(isPoint), zoom: maybe(isNumber) });
const isNote = objectOf({
  id: isText, position: isPoint, normal: maybe(isPoint), texts: mapOf(isTextOfNote, 1), picture: maybe(isText), view: maybe(isView), light: maybe(isText), section: maybe(isText),
});
const isStep = objectOf({ note: isText, seconds: maybe(isNumber), transition: maybe(isText) });
const isTour = objectOf({ id: isText, titles: mapOf(isText, 1), steps: listOf(isStep) });
// A body may also be a URL.
const isBody: Check = (value) => isText(value) || objectOf({ type: maybe(isText), id: maybe(isText), value: maybe(isText), language: maybe(isText) })(value);
const isSelector = objectOf({ type: maybe(isText), x: maybe(isNumber), y: maybe(isNumber), z: maybe(isNumber) });
// A target may also be the URL of a canvas, or a list of targets.
const isTarget: Check = (value) => isText(value) || Array.isArray(value) || objectOf({ selector: maybe(oneOrMore(isSelector)) })(value);
const isIiif = objectOf({ label: maybe(mapOf(listOf(isText), 0)), body: maybe(oneOrMore(isBody)), target: maybe(isTarget) });

export function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

export function isNoteList(value: unknown): value is StoredNote[] {
  return listOf(isNote)(value);
}

export function isTourList(value: unknown): value is StoredTour[] {
  return listOf(isTour)(value);
}

export function isAnnotation(value: unknown): value is IiifAnnotation {
  return isIiif(value);
}
