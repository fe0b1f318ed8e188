// SPDX-License-Identifier: Apache-2.0
// A scan's part of the interface, played in the browser's network: the test says how far it is.
export const kScan = "01hf0000000000000000000000";

export class FakeScan {
  points = new Float32Array();
  record = {
    id: kScan, job: kScan, scanner: "rig", state: "waiting", step: 0, steps: 720, progress: 0, eta: null, error: null, note: null,
    calibration: 1, points: 0, model: null, title: "Demosthenes", created: 0,
  };
  fault = null; // "network", or a status to answer with
  #asked = 0;
  #waiting = [];

  /** Before the page is opened. */
  async play(context) {
    await context.route("**/api/v1/scans/**", (route) => this.#answer(route));
  }

  /** How far it is, and how many points there are. */
  tell(changes, points) {
    Object.assign(this.record, changes);
    if (!points) return;
    this.points = points;
    this.record.points = points.length / 3;
  }

  /** Resolves when the page has asked `times` more. */
  asked(times = 1) {
    return new Promise((resolve) => this.#waiting.push({ at: this.#asked + times, resolve }));
  }

  get questions() {
    return this.#asked;
  }

  #answer(route) {
    const url = new URL(route.request().url());
    if (url.pathname.endsWith("/points")) return route.fulfill({ body: this.#from(Number(url.searchParams.get("from"))) });
    ++this.#asked;
    this.#waiting = this.#waiting.filter(({ at, resolve }) => this.#asked < at || void resolve());
    if (this.fault === "network") return route.abort("connectionrefused");
    if (this.fault !== null) return route.fulfill({ status: this.fault, json: {} });
    return route.fulfill({ json: this.record });
  }

  #from(first) {
    return Buffer.from(this.points.buffer, this.points.byteOffset + 12 * first, this.points.byteLength - 12 * first);
  }
}

/** Points on a mesh with y upwards as a scanner finds it: 80 mm high, z upwards, one side after the other. */
export function measured({ vertices, faces }, count) {
  const range = (axis) => vertices.reduce(([low, high], v) => [Math.min(low, v[axis]), Math.max(high, v[axis])], [Infinity, -Infinity]);
  const [x, y, z] = [0, 1, 2].map(range), scale = 80 / (y[1] - y[0]), middle = ([low, high]) => (low + high) / 2;
  const points = Array.from({ length: count }, (_, i) => {
    const [a, b, c] = faces[(i * 7919) % faces.length].map((corner) => vertices[corner]);
    let [u, v] = [(i * 0.7548776662) % 1, (i * 0.5698402910) % 1]; // evenly spread, the same each time
    if (u + v > 1) [u, v] = [1 - u, 1 - v];
    const at = (axis) => a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]);
    return [scale * (at(0) - middle(x)), scale * (middle(z) - at(2)), scale * (at(1) - y[0])];
  });
  points.sort((p, q) => Math.atan2(p[1], p[0]) - Math.atan2(q[1], q[0]));
  return new Float32Array(points.flat());
}
