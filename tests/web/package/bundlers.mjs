// SPDX-License-Identifier: Apache-2.0
// Builds pages with each bundler, as web/README.md says. `folder` is the folder of an Installed
// (installed.mjs). Entries are paths of the pages' scripts below `folder`. The bundles are written
// to `outDir`.
import vue from "@vitejs/plugin-vue";
import { build as esbuild } from "esbuild";
import { cpSync } from "node:fs";
import { join } from "node:path";
import { promisify } from "node:util";
import { build, createServer } from "vite";
import webpack from "webpack";

const kQuiet = { configFile: false, logLevel: "error" };
const kFrameworks = {
  esbuild: { jsx: "automatic" },
  plugins: [vue({ template: { compilerOptions: { isCustomElement: (tag) => tag === "progressive-mesh" } } })],
};

/** Builds several pages at once. The bundle of each page has the file name of the page's script. */
export async function buildWithVite(folder, entries, outDir) {
  const input = entries.map((entry) => join(folder, entry));
  await build({ ...kQuiet, ...kFrameworks, root: folder, build: { outDir, rollupOptions: { input, output: { entryFileNames: "[name].js" } } } });
}

export async function buildWithWebpack(folder, entry, outDir) {
  const stats = await promisify(webpack)({
    mode: "production", context: folder, entry: { plain: `./${entry}` }, performance: false, optimization: { minimize: false },
    output: { path: outDir },
  });
  if (stats.hasErrors()) throw new Error(stats.toString("errors-only"));
}

/**
 * Builds a page with esbuild. Copies the viewer's files to `assets`, by default beside the bundle,
 * because esbuild does not change `new URL(…, import.meta.url)`.
 */
export async function buildWithEsbuild(folder, entry, outDir, assets = outDir) {
  await esbuild({ entryPoints: [join(folder, entry)], outdir: outDir, bundle: true, splitting: true, format: "esm", logLevel: "error" });
  for (const name of ["progressive-mesh-worker.js", "progressive-mesh.wasm"]) {
    cpSync(join(folder, "node_modules/@vitrine/progressive-mesh/dist/package", name), join(assets, name));
  }
}

/**
 * Builds a script for a server. The result is a CommonJS module that exports what `entry` exports.
 */
export async function buildForServer(folder, entry, outfile) {
  await esbuild({ entryPoints: [join(folder, entry)], outfile, bundle: true, platform: "node", format: "cjs", jsx: "automatic", logLevel: "error", logOverride: { "empty-import-meta": "silent" } });
}

/** Starts Vite's development server with the pages in `folder`. */
export async function startVite(folder) {
  const server = await createServer({
    ...kQuiet, root: folder, cacheDir: join(folder, "vite-cache"), optimizeDeps: { exclude: ["@vitrine/progressive-mesh"] },
    server: { host: "127.0.0.1", port: 0, fs: { strict: false } },
  });
  await server.listen();
  return { url: `http://127.0.0.1:${server.httpServer.address().port}/`, close: () => server.close() };
}
