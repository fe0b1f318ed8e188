// SPDX-License-Identifier: Apache-2.0
import { iconOfStatement, iconsOfLicence } from "@ui/rights-icons.ts";
import { kRightsStatements, rightsLabel } from "@ui/rights.ts";
import { describe, expect, test } from "vitest";

const statement = (name: string) => `http://rightsstatements.org/vocab/${name}/1.0/`;

describe("rights", () => {
  test("a statement has its label by both schemes and by the address of its page", () => {
    expect(kRightsStatements).toHaveLength(12);
    expect(rightsLabel("http://rightsstatements.org/vocab/InC/1.0/")).toBe("In Copyright");
    expect(rightsLabel("https://rightsstatements.org/vocab/NKC/1.0/")).toBe("No Known Copyright");
    expect(rightsLabel("https://rightsstatements.org/page/NoC-NC/1.0/?language=en")).toBe("No Copyright – Non-Commercial Use Only");
    for (const other of ["https://example.org/", "http://rightsstatements.org/vocab/InC/2.0/", "http://rightsstatements.org/vocab/XY/1.0/", ""])
      expect(rightsLabel(other)).toBe(other);
  });

  test.each([
    ["CC-BY-NC-SA-4.0", ["cc", "by", "nc", "sa"]], ["cc by-nd 3.0", ["cc", "by", "nd"]], ["CC-BY-3.0-DE", ["cc", "by"]], ["CC0-1.0", ["cc", "zero"]],
    ["CC-PDM-1.0", ["noCopyright"]], ["https://creativecommons.org/licenses/by-nc/4.0/deed.en", ["cc", "by", "nc"]],
    ["http://creativecommons.org/publicdomain/zero/1.0/", ["cc", "zero"]], ["MIT", []], ["CC-BY", []], ["", []],
  ])("the icons of %s are %s", (licence, icons) => expect(iconsOfLicence(licence)).toEqual(icons));

  test.each([
    ["InC", ["inCopyright"]], ["InC-EDU", ["inCopyright"]], ["NoC-US", ["noCopyright"]], ["CNE", ["other"]], ["NKC", ["other"]],
  ])("the statement %s has the icon %s", (name, icons) => expect(iconOfStatement(statement(name))).toEqual(icons));

  test("other texts have no icon of a statement", () => expect(iconOfStatement("CC0-1.0")).toEqual([]));
});
