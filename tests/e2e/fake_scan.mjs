// SPDX-License-Identifier: Apache-2.0
// Simulates the API of one scan by intercepting the browser's requests. The test sets the scan's
// progress.
export const kScan = "01hf0000000000000000000000";

export class FakeScan {
  points = new Float32Array();
  record = {
    id: kScan, job: kScan, scanner: "rig", state: "waiting", step: 0, steps: 720, progress: 0, eta: null, error: null, note: null,
    calibration: 1, points: 0, model: null, title: "Demosthenes", created: 0,
  };
  fault = null; // the fault to simulate: "network" for a lost connection, or an HTTP status
  #asked = 0;
  #waiting = [];

  /** Intercepts the browser's requests. Must be called before the page is opened. */
  async play(context) {
    await context.route("**/api/v1/scans/**", (route) => this.#answer(route));
  }

  /** Updates the scan's record and, if `points` is given, its points. */
  tell(changes, points) {
    Object.assign(this.record, changes);
    if (!points) return;
    this.points = points;
    this.record.points = points.length / 3;
  }

  /** Resolves when the page has polled the scan `times` more times. */
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

/**
 * Returns `count` points of a mesh in the order in which a scanner measures them, by angle around
 * the turntable's axis. The points are scaled to a height of 80 mm, with z upwards. In the mesh, y
 * is upwards.
 */
export function measured({ vertices, faces }, count) {
  const range = (axis) => vertices.reduce(([low, high], v) => [Math.min(low, v[axis]), Math.max(high, v[axis])], [Infinity, -Infinity]);
  const [x, y, z] = [0, 1, 2].map(range), scale = 80 / (y[1] - y[0]), middle = ([low, high]) => (low + high) / 2;
  const points = Array.from({ length: count }, (_, i) => {
    const [a, b, c] = faces[(i * 7919) % faces.length].map((corner) => vertices[corner]);
    let [u, v] = [(i * 0.7548776662) % 1, (i * 0.5698402910) % 1]; // a low-discrepancy sequence: evenly spread and deterministic
    if (u + v > 1) [u, v] = [1 - u, 1 - v];
    const at = (axis) => a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]);
    return [scale * (at(0) - middle(x)), scale * (middle(z) - at(2)), scale * (at(1) - y[0])];
  });
  points.sort((p, q) => Math.atan2(p[1], p[0]) - Math.atan2(q[1], q[0]));
  return new Float32Array(points.flat());
}
