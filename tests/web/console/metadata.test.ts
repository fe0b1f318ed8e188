// SPDX-License-Identifier: Apache-2.0
import { contentsOf, rebase, type MetadataDraft } from "@console/metadata.ts";
import type { ModelRecord } from "@console/types.ts";
import { expect, test } from "vitest";

const model = { title: "Bust", creator: "", material: "marble", unit: "mm", accuracy: 0.05, public_max_level: null } as ModelRecord;
const draftOf = (typed: MetadataDraft["typed"]): MetadataDraft => ({ typed, stored: contentsOf(model), theirs: [] });

test("the form shows numbers and empty fields as texts", () =>
  expect(contentsOf(model)).toMatchObject({ title: "Bust", creator: "", doi: "", accuracy: "0.05", public_max_level: "" }));

test("the fields of somebody else are named, not the operator's own", () => {
  const draft = draftOf({ title: "Head" });
  rebase(draft, contentsOf({ ...model, creator: "Polyeuktos", unit: "cm" }), ["unit"]);
  expect(draft).toMatchObject({ typed: { title: "Head" }, theirs: ["creator"] });
  rebase(draft, contentsOf({ ...model, creator: "Polyeuktos", unit: "cm" }));
  expect(draft.theirs).toEqual(["creator"]); // until the operator saves
});

test("a text that is stored already is not unsaved", () => {
  const draft = draftOf({ title: "Head ", material: "bronze" });
  rebase(draft, contentsOf({ ...model, title: "Head" }));
  expect(draft.typed).toEqual({ material: "bronze" });
});
