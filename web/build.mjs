// SPDX-License-Identifier: Apache-2.0
// Builds dist/ from src/: node build.mjs progressive-mesh.wasm
// dist/ gets the files that the daemon serves, and dist/package gets the files of the npm package.
import { build } from "esbuild";
import { copyFile, mkdir, rm } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { leanThree } from "./lean_three.mjs";
import { meshFormats } from "./mesh_formats.mjs";

const root = dirname(fileURLToPath(import.meta.url));
const dist = join(root, "dist");
// folder of the npm package; the files beside it are the daemon's
const published = join(dist, "package");
const wasm = process.argv[2];
if (!wasm) throw new Error("name the decoder: node build.mjs progressive-mesh.wasm");

const common = { bundle: true, minify: true, target: "es2022", legalComments: "none", absWorkingDir: root, logLevel: "warning" };

/**
 * Handles `import text from "./x?text"`. The imported string is the style sheet or worker x,
 * bundled and minified.
 */
const asText = {
  name: "text",
  setup({ onResolve, onLoad }) {
    onResolve({ filter: /\?text$/ }, ({ path, resolveDir }) => ({
      path: join(resolveDir, path.replace(/\?text$/, "")),
      namespace: "text",
    }));
    onLoad({ filter: /.*/, namespace: "text" }, async ({ path }) => {
      const { outputFiles } = await build({ ...common, entryPoints: [path], format: "iife", write: false });
      return { contents: outputFiles[0].text, loader: "text", watchFiles: [path] };
    });
  },
};

/** Keeps three.js in a file of its own, beside the viewer's file. */
const threeBeside = {
  name: "three",
  setup({ onResolve }) {
    onResolve({ filter: /^three(\/.*)?$/ }, () => ({ path: "./three.js", external: true }));
  },
};

/** Makes the npm package load the worker from a file of its own. */
const workerBeside = {
  name: "worker",
  setup({ onResolve }) {
    onResolve({ filter: /\/worker-url\.ts$/ }, () => ({ path: join(root, "src/core/worker-url-of-package.ts") }));
  },
};

await rm(dist, { recursive: true, force: true });
await mkdir(dist);
await Promise.all([
  build({
    ...common,
    entryPoints: { "progressive-mesh": "src/element/index.ts" },
    chunkNames: "progressive-mesh-[name]",
    outdir: dist,
    format: "esm",
    splitting: true,
    plugins: [asText, threeBeside],
  }),
  build({ ...common, entryPoints: { three: "src/element/three-parts.ts" }, outdir: dist, format: "esm", plugins: [leanThree] }),
  build({
    ...common,
    entryPoints: { "progressive-mesh-loader": "src/three/index.ts" },
    outdir: dist,
    format: "esm",
    external: ["three"],
    plugins: [asText],
  }),
  build({
    ...common,
    entryPoints: { gallery: "src/gallery/gallery.ts", model: "src/gallery/model.ts", compare: "src/gallery/compare.ts", docs: "src/docs/docs.ts" },
    outdir: dist,
    format: "esm",
  }),
  build({ ...common, entryPoints: { scan: "src/gallery/scan.ts" }, outdir: dist, format: "esm", plugins: [threeBeside] }),
  build({
    ...common,
    entryPoints: { console: "src/console/console.ts" },
    chunkNames: "console-[name]",
    outdir: dist,
    format: "esm",
    splitting: true,
    plugins: [threeBeside],
    define: { MESH_FORMATS: JSON.stringify(meshFormats) },
  }),
  build({
    ...common,
    entryPoints: { "progressive-mesh": "src/element/index.ts", "progressive-mesh-loader": "src/three/index.ts" },
    chunkNames: "progressive-mesh-[name]-[hash]",
    outdir: published,
    format: "esm",
    splitting: true,
    external: ["three", "three/*"],
    plugins: [asText, workerBeside],
  }),
  build({ ...common, entryPoints: { "progressive-mesh-worker": "src/core/worker.ts" }, outdir: published, format: "iife" }),
  build({ ...common, entryPoints: { site: "src/gallery/site.css", console: "src/console/console.css" }, outdir: dist }),
]);

await Promise.all([
  ...[dist, published].map((folder) => copyFile(wasm, join(folder, "progressive-mesh.wasm"))),
  ...["favicon.svg", "index.html", "model.html", "compare.html", "scan.html"].map((page) => copyFile(join(root, "src/gallery", page), join(dist, page))),
  copyFile(join(root, "src/docs/docs.html"), join(dist, "docs.html")),
  copyFile(join(root, "src/console/console.html"), join(dist, "console.html")),
]);
