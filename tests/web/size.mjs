// SPDX-License-Identifier: Apache-2.0
// Checks the compressed size of the viewer, without three.js and Draco: node size.mjs DIST
import { execFileSync } from "node:child_process";
import { readdirSync } from "node:fs";
import { join } from "node:path";

const kMost = 60_000; // maximum number of compressed bytes of all code that is loaded before the visitor's tools

const dist = process.argv[2];
const kAfterwards = ["progressive-mesh-toolbox.js", "progressive-mesh-loader.js"]; // loaded after the first paint, or used instead of the element
// Files with the texts of one language; a visitor loads one of them.
const kLanguage = /^progressive-mesh-[a-z]{2}\.js$/;

const sizes = {};
for (const name of readdirSync(dist).filter((file) => file.startsWith("progressive-mesh")).sort()) {
  sizes[name] = execFileSync("zopfli", ["-c", join(dist, name)]).length;
  console.log(`${String(sizes[name]).padStart(7)} ${name}`);
}
const first = Object.keys(sizes).filter((name) => !kAfterwards.includes(name) && !kLanguage.test(name));
const language = Math.max(...Object.keys(sizes).filter((name) => kLanguage.test(name)).map((name) => sizes[name]));
const total = first.reduce((sum, name) => sum + sizes[name], language);
console.log(`${String(total).padStart(7)} before the tools: ${first.join(", ")} and a language, of at most ${kMost}`);
process.exitCode = total > 0 && total <= kMost ? 0 : 1;
