// SPDX-License-Identifier: Apache-2.0
import { kRightsStatements, licenceMark, rightsLabel } from "@ui/rights.ts";
import { describe, expect, test } from "vitest";

describe("rights", () => {
  test("a statement has its label by both schemes", () => {
    expect(kRightsStatements).toHaveLength(12);
    expect(rightsLabel("http://rightsstatements.org/vocab/InC/1.0/")).toBe("In Copyright");
    expect(rightsLabel("https://rightsstatements.org/vocab/NKC/1.0/")).toBe("No Known Copyright");
    expect(rightsLabel("https://example.org/")).toBe("https://example.org/");
  });

  test.each([["CC-BY-NC-SA-4.0", "BY NC SA"], ["CC0-1.0", "0"], ["CC-PDM-1.0", "PD"], ["MIT", ""], ["", ""]])("the icon of %s is %s", (licence, mark) => {
    expect(licenceMark(licence)).toBe(mark);
  });
});
