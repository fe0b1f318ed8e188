// SPDX-License-Identifier: Apache-2.0
// An esbuild plugin that bundles three.js from its sources without what the pages never use: WebXR,
// the shaders of other materials, and the comments and blanks of shaders.
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

const three = createRequire(import.meta.url).resolve("three/src/Three.js");

/** Shaders of materials that src/element/three-parts.ts does not export. */
const kUnusedShader = /ShaderLib\/(distanceRGBA|linedashed|meshlambert|meshmatcap|meshnormal|meshphong|meshtoon|sprite)\.glsl\.js$/;
const kNoShader = `export const vertex = "", fragment = "";`;

/** The part of WebXRManager that the renderer calls even if there is no XR session. */
const kNoXr = `export class WebXRManager {
  enabled = false;
  isPresenting = false;
  addEventListener() {}
  removeEventListener() {}
  setAnimationLoop() {}
  getEnvironmentBlendMode() {}
  dispose() {}
}`;

export const leanThree = {
  name: "lean three",
  setup({ onResolve, onLoad }) {
    onResolve({ filter: /^three$/ }, () => ({ path: three }));
    onLoad({ filter: /WebXRManager\.js$/ }, () => ({ contents: kNoXr }));
    onLoad({ filter: kUnusedShader }, () => ({ contents: kNoShader }));
    onLoad({ filter: /\.glsl\.js$/ }, async ({ path }) => ({ contents: withShortShaders(await readFile(path, "utf8")) }));
  },
};

/** Shortens all template literals of a module. In these modules, template literals are shaders. */
function withShortShaders(module) {
  return module.replace(/`([^`]*)`/g, (_, shader) => `\`\n${shortShader(shader)}\n\``);
}

/**
 * Removes comments, empty lines and blanks that have no meaning from GLSL. Does not join lines, because each
 * directive needs a line of its own.
 */
export function shortShader(glsl) {
  return glsl.replace(/\/\*[^]*?\*\//g, " ").replace(/\/\/.*/g, "").split("\n").map(shortLine).filter((line) => line !== "").join("\n");
}

/** Blanks around + and - stay, because "a - -b" differs from "a--b". */
function shortLine(line) {
  const trimmed = line.trim();
  return trimmed.startsWith("#") ? trimmed : trimmed.replace(/\s*([=*/,;(){}<>?:&|]+)\s*/g, "$1");
}
