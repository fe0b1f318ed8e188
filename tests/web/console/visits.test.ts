// SPDX-License-Identifier: Apache-2.0
import { percentage, spent } from "@console/visits.ts";

test.each([[0, "0 s"], [59, "59 s"], [60, "1 min"], [3_599, "59 min"], [3_600, "1 h 0 min"], [4_000_000, "1,111 h 6 min"]])(
  "%s seconds are %s", (seconds, text) => expect(spent(seconds)).toBe(text));

test("a part of nothing has no percentage", () => {
  expect(percentage(1, 3)).toBe("33 %");
  expect(percentage(0, 0)).toBe("");
});
