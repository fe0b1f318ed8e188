// SPDX-License-Identifier: Apache-2.0
// Tests the USDZ and 3MF files of `vitrine decode` with three.js: each must contain the same surface as the GLB. node --test
// packages.test.mjs
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { DOMParser } from "@xmldom/xmldom";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { ThreeMFLoader } from "three/examples/jsm/loaders/3MFLoader.js";
import { USDLoader } from "three/examples/jsm/loaders/USDLoader.js";
import { Box3, Color, LoadingManager, SRGBColorSpace } from "three";
import { readObj, writeColoured, writeStripedBall } from "../../e2e/models.mjs";

const vitrine = (...words) => execFileSync(join(process.env.VITRINE_BIN, "vitrine"), words, { encoding: "utf8" });

let folder;
before(async () => {
  folder = mkdtempSync(join(tmpdir(), "vitrine-"));
  await writeColoured(await readObj(process.env.VITRINE_MODEL), join(folder, "bust.ply"));
  await writeStripedBall(join(folder, "ball.glb"), { around: 16, up: 8, stripes: 4, columns: 128 });
  for (const [name, unit] of [["bust.ply", "mm"], ["ball.glb", "m"]])
    vitrine("build", join(folder, name), "-o", `${join(folder, name)}.pmesh`, "--unit", unit);
});
after(() => rmSync(folder, { recursive: true }));

function exported(name, format, ...words) {
  const out = join(folder, `out.${format}`);
  vitrine("decode", `${join(folder, name)}.pmesh`, "-o", out, "--force", ...words);
  return new Uint8Array(readFileSync(out)).buffer;
}

/** Returns the only mesh of a scene, its faces, and its bounding box. */
function described(scene) {
  scene.updateMatrixWorld(true);
  const meshes = [];
  scene.traverse((node) => node.isMesh && meshes.push(node));
  assert.equal(meshes.length, 1);
  const [{ geometry }] = meshes;
  return { mesh: meshes[0], faces: (geometry.index ?? geometry.attributes.position).count / 3, box: new Box3().setFromObject(scene, true) };
}

function assertSame(found, wanted) {
  assert.equal(found.faces, wanted.faces);
  const most = wanted.box.min.distanceTo(wanted.box.max) * 1e-5;
  for (const corner of ["min", "max"]) assert.ok(found.box[corner].distanceTo(wanted.box[corner]) < most, `${found.box[corner].toArray()}`);
}

const glb = async (name, ...words) => described((await new GLTFLoader().parseAsync(exported(name, "glb", ...words), "")).scene);
const usdz = (name, ...words) => described(new USDLoader().parse(exported(name, "usdz", ...words)));

test("three.js reads a USDZ in metres with y up, whatever its unit and axis", async () => {
  for (const level of ["0", "2"]) {
    const wanted = await glb("bust.ply", "--level", level);
    for (const words of [[], ["--unit", "mm", "--up", "z"]]) assertSame(usdz("bust.ply", "--level", level, ...words), wanted);
  }
});

test("three.js reads the normals of a USDZ", async () => {
  const { normal, position } = usdz("bust.ply", "--level", "0").mesh.geometry.attributes;
  assert.equal(normal.count, position.count);
  for (let v = 0; v < normal.count; ++v) assert.ok(Math.abs(Math.hypot(normal.getX(v), normal.getY(v), normal.getZ(v)) - 1) < 1e-3);
});

test("three.js finds the texture and its coordinates in a USDZ", async () => {
  const pictures = standInForPictures();
  const { mesh, faces } = usdz("ball.glb");
  assert.equal(faces, usdz("ball.glb", "--texture", "0").faces);
  assert.ok(mesh.material.map);
  assert.equal(mesh.material.map.colorSpace, SRGBColorSpace);
  assert.equal(mesh.geometry.attributes.uv.count, 3 * faces);
  assert.equal(pictures.length, 1);
  const bytes = new Uint8Array(await (await fetch(pictures[0])).arrayBuffer());
  assert.deepEqual([...bytes.subarray(0, 3)], [0xff, 0xd8, 0xff], "a JPEG");
});

/**
 * Replaces a browser's decoder of pictures. Returns a list that records the URLs of the requested
 * pictures.
 */
function standInForPictures() {
  const asked = [];
  globalThis.document = { createElementNS: () => ({ addEventListener() {}, removeEventListener() {}, set src(url) { asked.push(url); } }) };
  return asked;
}

/** Replaces a browser's XML parser. Adds the methods that three.js uses to find elements by name. */
function standInForXml() {
  const node = new DOMParser().parseFromString("<a/>", "text/xml");
  const all = (root, names) => names.split(" ").reduce((nodes, name) => nodes.flatMap((each) => Array.from(each.getElementsByTagNameNS("*", name))), [root]);
  for (const kind of [node, node.documentElement].map(Object.getPrototypeOf)) {
    kind.querySelectorAll = function (names) { return all(this, names); };
    kind.querySelector = function (names) { return all(this, names)[0] ?? null; };
  }
  globalThis.DOMParser = DOMParser;
}

test("three.js reads a 3MF in millimetres with z up, and its colours", async () => {
  standInForXml();
  const scene = new ThreeMFLoader(new LoadingManager()).parse(exported("bust.ply", "3mf", "--level", "0"));
  scene.scale.setScalar(0.001), scene.rotation.set(-Math.PI / 2, 0, 0);
  const found = described(scene), wanted = await glb("bust.ply", "--level", "0");
  assertSame(found, wanted);
  const mean = ({ mesh: { geometry } }) => {
    const { color } = geometry.attributes, corners = geometry.index?.array ?? Array.from({ length: color.count }, (_, v) => v), sum = [0, 0, 0];
    for (const corner of corners) new Color().fromBufferAttribute(color, corner).toArray().forEach((part, k) => (sum[k] += part / corners.length));
    return sum;
  };
  mean(found).forEach((part, k) => assert.ok(Math.abs(part - mean(wanted)[k]) < 1e-3, `${mean(found)} is not ${mean(wanted)}`));
});
