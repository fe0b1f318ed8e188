// SPDX-License-Identifier: Apache-2.0
import { readdirSync } from "node:fs";
import { inMillimetres } from "@texts/formats.ts";
import { textsIn } from "@texts/index.ts";
import { en as pageEn } from "@ui/texts/en.ts";

test.each([["de", "Messen"], ["de-AT", "Messen"], ["DE", "Messen"], ["en-GB", "Measure"], ["", "Measure"], ["nl", "Measure"], ["fr-CA", "Mesurer"], ["es", "Medir"], ["it", "Misura"]])(
  "'%s' says %s", async (language, word) => expect((await textsIn(language)).measure).toBe(word));

test("what is fetched once stays", () => expect(textsIn("de-CH")).toBe(textsIn("de")));

test("numbers are written as the language has them", async () => {
  const [en, de] = await Promise.all([textsIn("en"), textsIn("de")]);
  expect(en.triangles(1234, 56789)).toBe("1,234 of 56,789 triangles");
  expect(de.triangles(1234, 56789)).toBe("1.234 von 56.789 Dreiecken");
  expect(de.measured(12.3456, "mm")).toBe("12,35 mm");
  expect(en.measured(12.3456, "")).toBe("12.35 units");
});

test.each([[0.02, "m", 20, "mm"], [0.5, "mm", 0.5, "mm"], [2, "in", 50.8, "mm"], [3, "", 3, ""]])("%s %s are %s %s", (value, unit, shown, shownUnit) => {
  const [number, name] = inMillimetres(value, unit);
  expect(number).toBeCloseTo(shown);
  expect(name).toBe(shownUnit);
});

const kShared = ["format", "museum", "notes", "quality", "relief", "studio", "surface"]; // words that other languages share with English

test.each(["de", "es", "fr", "it"])("the language %s says everything, in words of its own", async (language) => {
  const [en, other] = await Promise.all([textsIn("en"), textsIn(language)]);
  const texts = Object.keys(en).filter((key) => typeof en[key as never] === "string" && !kShared.includes(key));
  expect(texts.filter((key) => !other[key as never] || other[key as never] === en[key as never])).toEqual([]);
  expect(Object.keys(other).sort()).toEqual(Object.keys(en).sort());
});

/** Returns the paths of all texts in `texts`, such as "facts.creator". */
function paths(texts: object, prefix = ""): string[] {
  return Object.entries(texts).flatMap(([key, value]) => (typeof value === "object" ? paths(value, `${prefix}${key}.`) : [prefix + key])).sort();
}

const languages = (folder: string) => readdirSync(new URL(`../../../web/src/${folder}`, import.meta.url))
  .filter((name) => /^[a-z]{2}\.ts$/.test(name)).map((name) => name.slice(0, 2)).sort();

test("the pages speak every language of the viewer", () => expect(languages("ui/texts")).toEqual(languages("texts")));

test.each(["de", "es", "fr", "it"])("no text of the pages lacks in the language %s", async (language) => {
  const texts = (await import(`../../../web/src/ui/texts/${language}.ts`))[language];
  expect(paths(texts)).toEqual(paths(pageEn));
});
