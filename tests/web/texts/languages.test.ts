// SPDX-License-Identifier: Apache-2.0
import { inMillimetres } from "@texts/formats.ts";
import { textsIn } from "@texts/index.ts";

test.each([["de", "Messen"], ["de-AT", "Messen"], ["DE", "Messen"], ["en-GB", "Measure"], ["", "Measure"], ["fr", "Measure"]])(
  "'%s' says %s", async (language, word) => expect((await textsIn(language)).measure).toBe(word));

test("what is fetched once stays", () => expect(textsIn("de-CH")).toBe(textsIn("de")));

test("numbers are written as the language has them", async () => {
  const [en, de] = await Promise.all([textsIn("en"), textsIn("de")]);
  expect(en.triangles(1234, 56789)).toBe("1,234 of 56,789 triangles");
  expect(de.triangles(1234, 56789)).toBe("1.234 von 56.789 Dreiecken");
  expect(de.distance(12.3456, "mm")).toBe("Abstand: 12,35 mm");
  expect(en.distance(12.3456, "")).toBe("Distance: 12.35 units");
});

test.each([[0.02, "m", 20, "mm"], [0.5, "mm", 0.5, "mm"], [2, "in", 50.8, "mm"], [3, "", 3, ""]])("%s %s are %s %s", (value, unit, shown, shownUnit) => {
  const [number, name] = inMillimetres(value, unit);
  expect(number).toBeCloseTo(shown);
  expect(name).toBe(shownUnit);
});

test("every language says everything, in words of its own", async () => {
  const [en, de] = await Promise.all([textsIn("en"), textsIn("de")]);
  const same = (a: object, b: object): string[] => Object.keys(a).filter((key) => JSON.stringify(a[key as never]) === JSON.stringify(b[key as never]) && typeof a[key as never] === "string");
  expect(same(en, de).filter((key) => key !== "format")).toEqual([]);
  expect(Object.keys(de).sort()).toEqual(Object.keys(en).sort());
});
