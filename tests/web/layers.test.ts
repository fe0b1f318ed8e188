// SPDX-License-Identifier: Apache-2.0
// Checks that the folders of web/src import each other only as this table permits, and never in a cycle.
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, normalize, relative } from "node:path";
import { expect, test } from "vitest";

const src = join(import.meta.dirname, "../../web/src");
const permitted: Record<string, string[]> = {
  core: [],
  texts: [],
  three: ["core"],
  element: ["core", "three", "texts"],
  ui: ["element", "texts"],
  docs: ["ui"],
  gallery: ["ui"],
  console: ["ui"],
};
const files = readdirSync(src, { recursive: true, encoding: "utf8" }).filter((name) => name.endsWith(".ts"));
const imports = new Map(files.map((file) => [file, importsOf(file)]));

function importsOf(file: string): string[] {
  const text = readFileSync(join(src, file), "utf8");
  const found = text.matchAll(/^(?:import|export)(?! type)[^;]*? from "(\.[^"]+)"|import\("(\.[^"]+)"\)/gm);
  return [...found].map(([, fixed, loaded]) => normalize(join(dirname(file), fixed ?? loaded ?? "")));
}

function folder(file: string): string {
  return relative(".", file).split("/")[0] ?? "";
}

test("a folder imports only what the table permits", () => {
  const faults = [...imports].flatMap(([file, targets]) => targets
    .filter((target) => folder(target) !== folder(file) && !permitted[folder(file)]?.includes(folder(target)))
    .map((target) => `${file} imports ${target}`));
  expect(faults).toEqual([]);
});

test("no file imports itself, directly or not", () => {
  const circles = files.filter((file) => reaches(file, file, new Set()));
  expect(circles).toEqual([]);
});

function reaches(from: string, goal: string, seen: Set<string>): boolean {
  return (imports.get(from) ?? []).some((next) => {
    if (next === goal) return true;
    if (seen.has(next)) return false;
    seen.add(next);
    return reaches(next, goal, seen);
  });
}
