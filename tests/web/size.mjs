// SPDX-License-Identifier: Apache-2.0
// Checks the compressed size of the code that a first visit loads: node size.mjs DIST
import { execFileSync } from "node:child_process";
import { readdirSync } from "node:fs";
import { join } from "node:path";

// Limit, in compressed bytes, for all code that is loaded before the visitor's tools: the viewer with
// its decoder, and three.js.
const kMost = 180_000;

const dist = process.argv[2];
// Files that are loaded after the first paint, or that are used instead of the element.
const kAfterwards = [
  "toolbox", "room", "contact-shadow", "profile", "qr-code", "note-reader", "augmented-reality", "loader",
].map((name) => `progressive-mesh-${name}.js`);
// Matches files with the texts of one language. A visitor loads only one of these files.
const kLanguage = /^progressive-mesh-[a-z]{2}\.js$/;

const sizes = {};
for (const name of readdirSync(dist).filter((file) => file === "three.js" || file.startsWith("progressive-mesh")).sort()) {
  sizes[name] = execFileSync("zopfli", ["-c", join(dist, name)]).length;
  console.log(`${String(sizes[name]).padStart(7)} ${name}`);
}
const first = Object.keys(sizes).filter((name) => !kAfterwards.includes(name) && !kLanguage.test(name));
const language = Math.max(...Object.keys(sizes).filter((name) => kLanguage.test(name)).map((name) => sizes[name]));
const total = first.reduce((sum, name) => sum + sizes[name], language);
console.log(`${String(total).padStart(7)} before the tools: ${first.join(", ")} and a language, of at most ${kMost}`);
process.exitCode = total > 0 && total <= kMost ? 0 : 1;
