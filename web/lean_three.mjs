// SPDX-License-Identifier: Apache-2.0
// An esbuild plugin that bundles three.js from its sources, without the parts that the pages never
// use. It leaves out parts of the renderer such as WebXR and shadow maps, shaders of other materials,
// and parts of shaders for other features. It also removes the comments and blanks of shaders.
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { basename } from "node:path";

const three = createRequire(import.meta.url).resolve("three/src/Three.js");

/**
 * Name patterns of the shaders that the pages do not use: those of other materials and lights (src/element/three-parts.ts),
 * and those for pictures as backgrounds.
 */
const kUnusedShaders = [
  "ShaderLib/(background|backgroundCube|cube|distanceRGBA|equirect|linedashed|meshlambert|meshmatcap|meshnormal|meshphong|meshtoon)",
  "ShaderLib/(points|shadow|sprite|vsm)",
  "ShaderChunk/(bsdfs|gradientmap_\\w+|lights_(lambert|phong|toon)_\\w+|shadowmask_\\w+)",
];
const kUnusedShader = new RegExp(`(${kUnusedShaders.join("|")})\\.glsl\\.js$`);
const kNoShader = `export const vertex = "", fragment = ""; export default "";`;

/** Features of three.js's shaders that no page uses, such as those of MeshPhysicalMaterial, animation, instancing, shadow maps and fog. */
const kUnusedFeatures = [
  "ALPHAHASH", "ALPHAMAP", "ANISOTROPY", "BATCHING", "BUMPMAP", "CLEARCOAT", "DISPERSION", "DISPLACEMENTMAP", "FOG", "GRADIENTMAP", "INSTANCING",
  "IRIDESCENCE", "LIGHTMAP", "LIGHT_PROBES", "LOGDEPTHBUF", "MATCAP", "MORPH", "REVERSEDEPTHBUF", "SHADOWMAP", "SHEEN", "SKINNING", "SPECULAR",
  "THICKNESSMAP", "TRANSMISSION",
];
const kUnusedDefine = `(?:PHYSICAL|IOR|USE_(?:${kUnusedFeatures.join("|")})\\w*)`;
/**
 * Matches a term of a condition that is always false: a test for one of kUnusedFeatures, or for
 * lights or shadows that no scene has.
 */
const kUnusedTerm = new RegExp(`^(defined${kUnusedDefine}|NUM_(RECT_AREA_LIGHTS|POINT_LIGHTS|SPOT_LIGHTS|SPOT_LIGHT_\\w+|\\w+_SHADOWS)>0)$`);

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

/**
 * Replacements for modules of the renderer that the pages never need. Each has only the functions
 * that the renderer calls.
 */
const kStandIns = {
  DirectionalLightShadow: "export class DirectionalLightShadow { dispose() {} }",
  WebGLShadowMap: "export class WebGLShadowMap { enabled = false; type = 1; render() {} }",
  WebGLCubeMaps: "export function WebGLCubeMaps() { return { get: (texture) => texture, dispose() {} }; }",
  WebGLCubeUVMaps: "export function WebGLCubeUVMaps() { return { get: (texture) => texture, dispose() {} }; }",
  WebGLMorphtargets: "export function WebGLMorphtargets() { return { update() {} }; }",
  WebGLUniformsGroups: "export function WebGLUniformsGroups() { return { dispose() {} }; }",
  WebXRManager: kNoXr,
  BoxGeometry: "export class BoxGeometry {}",
  PlaneGeometry: "export class PlaneGeometry {}",
};

export const leanThree = {
  name: "lean three",
  setup({ onResolve, onLoad }) {
    onResolve({ filter: /^three$/ }, () => ({ path: three }));
    onLoad({ filter: new RegExp(`/(${Object.keys(kStandIns).join("|")})\\.js$`) }, ({ path }) => ({ contents: kStandIns[basename(path, ".js")] }));
    onLoad({ filter: kUnusedShader }, () => ({ contents: kNoShader }));
    onLoad({ filter: /\.glsl\.js$/ }, async ({ path }) => ({ contents: withShortShaders(await readFile(path, "utf8")) }));
  },
};

/** Shortens all template literals of a module. In these modules, template literals are shaders. */
function withShortShaders(module) {
  return module.replace(/`([^`]*)`/g, (_, shader) => `\`\n${shortShader(withoutUnused(shader))}\n\``);
}

/**
 * Removes comments, empty lines and unnecessary blanks from GLSL. Does not join lines, because each
 * directive needs a line of its own.
 */
export function shortShader(glsl) {
  return glsl.replace(/\/\*[^]*?\*\//g, " ").replace(/\/\/.*/g, "").split("\n").map(shortLine).filter((line) => line !== "").join("\n");
}

/**
 * Removes unnecessary blanks from a line. Keeps blanks around + and -, because "a - -b" differs
 * from "a--b".
 */
function shortLine(line) {
  const trimmed = line.trim();
  return trimmed.startsWith("#") ? trimmed : trimmed.replace(/\s*([=*/,;(){}<>?:&|]+)\s*/g, "$1");
}

/** Removes the branches of GLSL that are compiled only for features that no material of the pages has. */
export function withoutUnused(glsl) {
  const kept = [], open = []; // for each enclosing conditional: isOff (branch removed), isLast (later branches removed), hasIf (an #if was kept)
  for (const line of glsl.split("\n")) {
    const [, word, condition = ""] = /^\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b(.*)/.exec(line) ?? [];
    if (word?.startsWith("if")) open.push({ isOff: false, isLast: false, hasIf: false });
    const branch = open.at(-1), isAround = open.slice(0, word ? -1 : undefined).every(({ isOff }) => !isOff);
    const rest = word === undefined ? line : word === "endif" ? (open.pop().hasIf ? line : undefined) : enter(branch, word, condition, line);
    if (rest !== undefined && isAround) kept.push(rest);
  }
  return kept.join("\n");
}

/**
 * Enters a branch of a conditional. Returns the directive that replaces `line`, or undefined if the
 * line is removed.
 */
function enter(branch, word, condition, line) {
  branch.isOff = branch.isLast || (word === "ifdef" ? isUnused(`defined(${condition})`) : word !== "else" && word !== "ifndef" && isUnused(condition));
  const isSure = word === "ifndef" && isUnused(`defined(${condition})`);
  branch.isLast ||= isSure;
  if (branch.isOff || isSure || (word === "else" && !branch.hasIf)) return undefined;
  const directive = branch.hasIf ? line : line.replace("elif", "if");
  branch.hasIf = true;
  return directive;
}

/**
 * Whether a condition is always false: each alternative has a term that is always false. Ignores parentheses, which is correct
 * because these terms are not negated.
 */
function isUnused(condition) {
  const term = (text) => kUnusedTerm.test(text.replace(/[\s()]/g, ""));
  return condition.split("||").every((alternative) => alternative.split("&&").some(term));
}
