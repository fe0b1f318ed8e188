// SPDX-License-Identifier: Apache-2.0
// Tests the npm package as it would be published: its contents, its TypeScript types, and that a user's bundle includes
// only the code that the user's program needs.
// node package.mjs
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const web = fileURLToPath(new URL("../../web/", import.meta.url));
const require = createRequire(join(web, "package.json"));
const { build } = require("esbuild");

const folder = mkdtempSync(join(tmpdir(), "vitrine-package-"));
try {
  const [{ filename, files }] = JSON.parse(
    execFileSync("npm", ["pack", "--json", "--silent", "--pack-destination", folder], { cwd: web, encoding: "utf8" }));
  checkContent(files.map(({ path }) => path));
  const installed = join(folder, "node_modules/@vitrine/progressive-mesh");
  mkdirSync(installed, { recursive: true });
  execFileSync("tar", ["-xzf", join(folder, filename), "-C", installed, "--strip-components=1"]);
  for (const peer of ["three", "@types"]) symlinkSync(join(web, "node_modules", peer), join(folder, "node_modules", peer));
  checkTypes();
  await checkShaking();
  for (const example of ["three.js", "react-three-fiber.jsx"]) await checkExample(join(installed, "examples", example));
} finally {
  rmSync(folder, { recursive: true, force: true });
}

function checkContent(paths) {
  const wanted = ["package.json", "README.md", "dist/progressive-mesh.js", "dist/progressive-mesh-loader.js", "dist/progressive-mesh.wasm",
    "dist/draco_decoder.js", "dist/draco_decoder.wasm", "dist/three.js", "dist/types/three/index.d.ts", "dist/types/element/index.d.ts",
    "examples/plain.html", "examples/three.html", "examples/three.js", "examples/react-three-fiber.jsx"];
  for (const path of wanted) assert.ok(paths.includes(path), `${path} is in the package`);
  const strange = paths.filter((path) => !/^(package\.json|README\.md|dist\/(progressive-mesh|draco_decoder|three\.js|types\/)|examples\/)/.test(path));
  assert.deepEqual(strange, [], "nothing else is");
}

/** Type-checks a user's program in strict mode, with no other types than those of three.js. */
function checkTypes() {
  const user = join(folder, "user.ts");
  writeFileSync(user, `
    import { PerspectiveCamera, Scene } from "three";
    import { ModelError, ProgressiveMeshLoader, setBudget, type ProgressiveMesh } from "@vitrine/progressive-mesh";
    import "@vitrine/progressive-mesh/element";
    setBudget({ triangles: 1e6, bytes: 1e8 });
    const mesh: ProgressiveMesh = await new ProgressiveMeshLoader().loadAsync("bust.pmesh");
    new Scene().add(mesh);
    const reached: boolean = await mesh.refineFor(new PerspectiveCamera(), 640, 480);
    mesh.addEventListener("error", ({ error }) => { const known: ModelError = error; throw known; });
    // @ts-expect-error: a detail request has no such member
    await mesh.refine({ sharpness: reached });`);
  const flags = "--noEmit --strict --target es2022 --module esnext --moduleResolution bundler --lib es2022,dom --skipLibCheck".split(" ");
  execFileSync(join(web, "node_modules/.bin/tsc"), [...flags, user], { cwd: folder, stdio: "inherit" });
}

async function checkShaking() {
  const size = async (contents) => {
    const { outputFiles } = await build({ stdin: { contents, resolveDir: folder }, bundle: true, minify: true, format: "esm", external: ["three"], write: false, logLevel: "error" });
    return outputFiles[0].contents.length;
  };
  const loader = await size(`export { ProgressiveMeshLoader } from "@vitrine/progressive-mesh";`);
  const error = await size(`export { ModelError } from "@vitrine/progressive-mesh";`);
  const nothing = await size(`import "@vitrine/progressive-mesh";`);
  console.log(`bundled: loader ${loader}, one class of it ${error}, nothing of it ${nothing} bytes`);
  assert.ok(error < 0.1 * loader && nothing < 100);
}

/** Checks that the example at `path` parses and that the package exports everything that it imports. */
async function checkExample(path) {
  const { metafile } = await build({ entryPoints: [path], bundle: true, write: false, metafile: true, format: "esm", jsx: "automatic", logLevel: "error",
    external: ["three", "three/*", "@react-three/*", "react", "react/*"] });
  assert.ok(Object.keys(metafile.inputs).some((input) => input.includes("progressive-mesh-loader.js")));
}
