// SPDX-License-Identifier: Apache-2.0
// Builds dist/ from src/: node build.mjs progressive-mesh.wasm
import { build } from "esbuild";
import { copyFile, mkdir, rm } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { meshFormats } from "./mesh_formats.mjs";

const root = dirname(fileURLToPath(import.meta.url));
const dist = join(root, "dist");
const wasm = process.argv[2];
if (!wasm) throw new Error("name the decoder: node build.mjs progressive-mesh.wasm");

const common = { bundle: true, minify: true, target: "es2022", legalComments: "none", absWorkingDir: root, logLevel: "warning" };

/** Handles `import text from "./x?text"`. The import is a string: the style sheet or worker x, bundled and minified. */
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

/** Keeps three.js in a separate file beside the viewer. */
const threeBeside = {
  name: "three",
  setup({ onResolve }) {
    onResolve({ filter: /^three(\/.*)?$/ }, () => ({ path: "./three.js", external: true }));
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
  build({ ...common, entryPoints: { three: "src/element/three-parts.ts" }, outdir: dist, format: "esm" }),
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
    entryPoints: { gallery: "src/gallery/gallery.ts", model: "src/gallery/model.ts", docs: "src/docs/docs.ts" },
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
  build({ ...common, entryPoints: { site: "src/gallery/site.css", console: "src/console/console.css" }, outdir: dist }),
]);

const draco = dirname(createRequire(import.meta.url).resolve("draco3d"));
await Promise.all([
  copyFile(wasm, join(dist, "progressive-mesh.wasm")),
  copyFile(join(draco, "draco_decoder_nodejs.js"), join(dist, "draco_decoder.js")),
  copyFile(join(draco, "draco_decoder.wasm"), join(dist, "draco_decoder.wasm")),
  ...["index.html", "model.html", "scan.html"].map((page) => copyFile(join(root, "src/gallery", page), join(dist, page))),
  copyFile(join(root, "src/docs/docs.html"), join(dist, "docs.html")),
  copyFile(join(root, "src/console/console.html"), join(dist, "console.html")),
]);
