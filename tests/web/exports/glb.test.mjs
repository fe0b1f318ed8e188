// SPDX-License-Identifier: Apache-2.0
// Tests the GLB files of `vitrine decode` with Khronos' validator and with three.js. The decoders of Draco and meshopt are those
// that browsers use.
// node --test glb.test.mjs
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import draco3d from "draco3d";
import validator from "gltf-validator";
import { MeshoptDecoder } from "meshoptimizer";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { BufferAttribute, BufferGeometry, Vector3 } from "three";

const kCompressions = ["none", "meshopt", "draco"];
const vitrine = (...words) => execFileSync(join(process.env.VITRINE_BIN, "vitrine"), words, { encoding: "utf8" });

let folder, levels, info;
before(() => {
  folder = mkdtempSync(join(tmpdir(), "vitrine-"));
  vitrine("build", process.env.VITRINE_MODEL, "-o", join(folder, "a.pmesh"), "--unit", "mm");
  info = JSON.parse(vitrine("info", join(folder, "a.pmesh"), "--json"));
  levels = info.levels;
});
after(() => rmSync(folder, { recursive: true }));

function exported(level, compression, ...more) {
  const out = join(folder, `${level}-${compression}.glb`);
  vitrine("decode", join(folder, "a.pmesh"), "-o", out, "--force", "--level", `${level}`, "--compression", compression, ...more);
  return readFileSync(out);
}

/** Replaces three.js' DRACOLoader, which needs the workers of a browser. */
class DracoLoader {
  preload() {}

  async decodeDracoFile(bytes, onLoad, ids, types) {
    const module = await draco3d.createDecoderModule({});
    const decoder = new module.Decoder(), mesh = new module.Mesh(), buffer = new module.DecoderBuffer();
    buffer.Init(new Int8Array(bytes), bytes.byteLength);
    assert.ok(decoder.DecodeBufferToMesh(buffer, mesh).ok());
    const geometry = new BufferGeometry();
    for (const [name, id] of Object.entries(ids)) {
      const attribute = decoder.GetAttributeByUniqueId(mesh, id), values = new module.DracoFloat32Array();
      decoder.GetAttributeFloatForAllPoints(mesh, attribute, values);
      const scale = { Uint8Array: 255, Uint16Array: 65535 }[types[name]] ?? 1;
      const numbers = Float32Array.from({ length: values.size() }, (_, i) => values.GetValue(i) / scale);
      geometry.setAttribute(name, new BufferAttribute(numbers, attribute.num_components()));
    }
    const corners = [], face = new module.DracoInt32Array();
    for (let f = 0; f < mesh.num_faces(); ++f) {
      decoder.GetFaceFromMesh(mesh, f, face);
      for (let k = 0; k < 3; ++k) corners.push(face.GetValue(k));
    }
    geometry.setIndex(corners);
    onLoad(geometry);
  }
}

/** Returns the mesh as three.js loads it: positions in mm, the corners of faces, and the lengths of normals. */
async function loaded(glb) {
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).setDRACOLoader(new DracoLoader());
  await MeshoptDecoder.ready;
  const { scene } = await loader.parseAsync(new Uint8Array(glb).buffer, "");
  scene.updateMatrixWorld(true);
  const points = [];
  let mesh;
  scene.traverse((node) => (mesh = node.isMesh ? node : mesh));
  const { position, normal } = mesh.geometry.attributes;
  for (let v = 0; v < position.count; ++v) points.push(new Vector3().fromBufferAttribute(position, v).applyMatrix4(mesh.matrixWorld).multiplyScalar(1000));
  const lengths = Array.from({ length: normal.count }, (_, v) => new Vector3().fromBufferAttribute(normal, v).length());
  return { points, corners: Array.from(mesh.geometry.index.array), lengths };
}

/** Returns the mean of the corners' positions, which does not depend on the order of vertices and faces. */
function cornerMean({ points, corners }) {
  const sum = new Vector3();
  for (const corner of corners) sum.add(points[corner]);
  return sum.divideScalar(corners.length);
}

for (const compression of kCompressions) {
  test(`${compression}: the validator finds no error and no warning`, async () => {
    for (const level of [0, levels.length - 1]) {
      const { issues } = await validator.validateBytes(new Uint8Array(exported(level, compression)));
      assert.deepEqual(issues.messages.filter(({ severity }) => severity < 2), []);
    }
  });
}

for (const compression of kCompressions) {
  test(`${compression}: a GLB with several levels is valid, and three.js shows the finest`, async () => {
    const level = levels.length - 1, glb = exported(level, compression, "--lod", "msft");
    const { issues, info: { totalTriangleCount } } = await validator.validateBytes(new Uint8Array(glb));
    assert.deepEqual(issues.messages.filter(({ severity }) => severity < 2), []);
    assert.ok(totalTriangleCount > levels[level].faces, `${totalTriangleCount} triangles in all levels`);
    assert.equal((await loaded(glb)).corners.length, 3 * levels[level].faces);
  });
}

for (const compression of ["meshopt", "draco"]) {
  test(`${compression}: three.js shows the same surface, within the lattice`, async () => {
    for (const level of [0, levels.length - 1]) {
      const plain = await loaded(exported(level, "none")), small = await loaded(exported(level, compression));
      assert.equal(small.corners.length, plain.corners.length);
      assert.equal(small.points.length, plain.points.length);
      // The cells of a coarse level have at most 2^8 times the step of the lattice.
      const cell = level === 0 ? info.step * 256 : info.step;
      assert.ok(cornerMean(small).distanceTo(cornerMean(plain)) < cell / 2);
      for (const length of small.lengths) assert.ok(Math.abs(length - 1) < 0.02);
    }
  });

  test(`${compression}: the vertices of the finest level are the points of the lattice`, async () => {
    const level = levels.length - 1;
    const wanted = new Set((await loaded(exported(level, "none"))).points.map(latticePoint));
    for (const point of (await loaded(exported(level, compression))).points) assert.ok(wanted.has(latticePoint(point)), `${point.toArray()}`);
  });
}

function latticePoint({ x, y, z }) {
  return [x, y, z].map((part, axis) => Math.round((part - info.origin[axis]) / info.step)).join();
}
