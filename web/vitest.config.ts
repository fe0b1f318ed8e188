// SPDX-License-Identifier: Apache-2.0
// Configures Vitest. The web client's tests are in tests/web.
import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";
import { meshFormats } from "./mesh_formats.mjs";

const path = (relative: string) => fileURLToPath(new URL(relative, import.meta.url));

export default defineConfig({
  root: path("../tests/web"),
  cacheDir: path("node_modules/.vite"),
  resolve: { alias: { "@console": path("src/console"), "@core": path("src/core"), "@docs": path("src/docs"), "@element": path("src/element"), "@texts": path("src/texts"), "@three": path("src/three"), "@ui": path("src/ui"), three: path("node_modules/three") } },
  define: { MESH_FORMATS: JSON.stringify(meshFormats) },
  test: { globals: true, include: ["**/*.test.ts"] },
});
