// SPDX-License-Identifier: Apache-2.0
// The tests lie in tests/web, beside those of the other folders.
import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";

const path = (relative: string) => fileURLToPath(new URL(relative, import.meta.url));

export default defineConfig({
  root: path("../tests/web"),
  cacheDir: path("node_modules/.vite"),
  resolve: { alias: { "@console": path("src/console"), "@core": path("src/core"), "@docs": path("src/docs"), "@element": path("src/element"), "@gallery": path("src/gallery"), "@texts": path("src/texts"), "@three": path("src/three"), three: path("node_modules/three") } },
  test: { globals: true, include: ["**/*.test.ts"] },
});
