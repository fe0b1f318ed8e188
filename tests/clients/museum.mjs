// SPDX-License-Identifier: Apache-2.0
// A real daemon with two published models, whose exports the clients read: "bust", a scan in millimetres with vertex colours, and
// "ball", a textured model in metres. Environment: VITRINE_BIN, VITRINE_MODEL (an OBJ file of triangles).
import assert from "node:assert/strict";
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { Daemon } from "../e2e/daemon.mjs";
import { readObj, writeColoured, writeStripedBall } from "../e2e/models.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: mesh } = process.env;
const kAround = 32, kUp = 16;

/** Returns the size of the bounding box along x, y and z, times `scale`. */
function extent(vertices, scale) {
  return [0, 1, 2].map((axis) => {
    const [low, high] = vertices.reduce(([a, b], v) => [Math.min(a, v[axis]), Math.max(b, v[axis])], [Infinity, -Infinity]);
    return (high - low) * scale;
  });
}

export class Museum {
  /** Starts the daemon and publishes both models. */
  static async open() {
    const museum = new Museum();
    museum.daemon = await Daemon.start(bin);
    const scan = await readObj(mesh), { folder } = museum.daemon;
    await writeColoured(scan, join(folder, "bust.ply"));
    await writeStripedBall(join(folder, "ball.glb"), { around: kAround, up: kUp, stripes: 24 });
    // Sizes are in metres, with y up.
    museum.scan = { triangles: scan.faces.length, size: extent(scan.vertices, 1e-3) };
    await museum.add("bust", museum.scan, join(folder, "bust.ply"), "--unit", "mm", "--creator", "A. Sculptor", "--licence", "CC-BY-4.0");
    // The ball has kUp bands of kAround quads, of two triangles each. In the two bands at the poles, each quad is one triangle.
    await museum.add("ball", { triangles: 2 * kAround * (kUp - 1), size: [2, 2, 2] }, join(folder, "ball.glb"), "--unit", "m");
    return museum;
  }

  models = {};

  get url() {
    return this.daemon.url;
  }

  /** Publishes a file as the model `name`. `described` has its number of triangles, and its size in metres with y up. */
  async add(name, described, file, ...words) {
    const page = await this.daemon.publish(file, name, ...words);
    this.models[name] = { ...described, id: page.split("/").pop() };
  }

  /** Returns the URL of the model `name` in the API. */
  api(name) {
    return `${this.url}/api/v1/models/${this.models[name].id}`;
  }

  /** Fetches an export of a whole model, such as `await exported("bust", "glb", "compression=draco")`. Returns its bytes. */
  async exported(name, format, query = "") {
    const answer = await fetch(`${this.api(name)}/export.${format}?${query}`);
    assert.equal(answer.status, 200, `${name}.${format}`);
    return Buffer.from(await answer.arrayBuffer());
  }

  /** Writes an export of a whole model to a file. Returns the file's path. */
  async saved(name, format, query) {
    const path = join(this.daemon.folder, `${name}-export.${format}`);
    await writeFile(path, await this.exported(name, format, query));
    return path;
  }

  async json(path) {
    const answer = await fetch(this.url + path);
    assert.equal(answer.status, 200, path);
    return answer.json();
  }

  stop() {
    return this.daemon.stop();
  }
}

/**
 * Checks a model as a client has read it. `size` is the extent along x, y and z, by default in metres with y up. `scale` is the
 * number of the format's units per metre. `zUp` is true if z points up in the format.
 */
export function assertSame({ triangles, size }, wanted, { scale = 1, zUp = false } = {}) {
  assert.equal(triangles, wanted.triangles);
  const [x, y, z] = wanted.size, expected = (zUp ? [x, z, y] : [x, y, z]).map((length) => length * scale);
  const most = Math.max(...expected) / 1000;
  expected.forEach((length, axis) => assert.ok(Math.abs(size[axis] - length) < most, `${size} is not ${expected}`));
}
