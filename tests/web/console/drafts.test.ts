// SPDX-License-Identifier: Apache-2.0
import { forgetAllDrafts, forgetDrafts, isUnsaved, newDrafts } from "@console/drafts.ts";
import { afterEach, expect, test } from "vitest";

const [texts, notes] = [newDrafts<string>(), newDrafts<string>()];
afterEach(forgetAllDrafts);

test("unsaved changes of any kind count", () => {
  expect(isUnsaved()).toBe(false);
  notes.set("a", "note");
  expect(isUnsaved()).toBe(true);
});

test("the unsaved changes of one model are discarded, and all of all models", () => {
  texts.set("a", "title").set("b", "title");
  notes.set("a", "note");
  forgetDrafts("a");
  expect([[...texts.keys()], notes.size]).toEqual([["b"], 0]);
  notes.set("c", "note");
  forgetAllDrafts();
  expect([texts.size, notes.size]).toEqual([0, 0]);
});
