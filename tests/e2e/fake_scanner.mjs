// SPDX-License-Identifier: Apache-2.0
// Simulates the API of a scanner during a calibration, by intercepting the browser's requests. Each
// request "resume" means that the operator has placed the target.
const kCalibrate = "01hf0000000000000000000001";

export class FakeScanner {
  stops = 0;
  /** HTTP status of the responses to emergency stops. */
  stopStatus = 200;
  pose = 0;
  state = "paused";

  constructor(poses) {
    this.poses = poses;
  }

  async play(context) {
    await context.route("**/api/v1/scanners**", (route) => this.#scanner(route));
    await context.route("**/api/v1/scanners/**", (route) => this.#scanner(route));
    await context.route(`**/api/v1/jobs/${kCalibrate}**`, (route) => this.#job(route));
    await context.route(`**/api/v1/jobs/${kCalibrate}/*`, (route) => this.#job(route));
  }

  get job() {
    const waits = this.state === "paused";
    return {
      id: kCalibrate, kind: "calibrate", state: this.state, stage: waits ? `place the target, pose ${this.pose + 1} of ${this.poses}` : "calibrating",
      progress: this.pose / this.poses, eta: null, error: null, note: "the target was seen in 4 pictures", scanner: "rig", scan: null, model: null,
      created: "2026-01-01T00:00:00Z", ended: this.state === "done" ? "2026-01-01T00:01:00Z" : null,
    };
  }

  #scanner(route) {
    const { pathname } = new URL(route.request().url()), power = { state: this.stopStatus === 200 ? "off" : "unknown", since: "2026-01-01T00:00:00Z" }, record = {
      id: "rig", name: "rig", state: "idle", camera: { vendor: "Aravis", model: "Fake", serial: "GV01" }, board: { dialect: "horus", firmware: "Horus 1" },
      calibration: this.state === "done" ? 1 : null, scan: null, problem: null, laser: power, motor: power,
    };
    if (pathname.endsWith("/stop")) {
      ++this.stops;
      return route.fulfill({ status: this.stopStatus, json: this.stopStatus === 200 ? record : { title: "Bad", status: this.stopStatus, detail: "the board is gone; plug it in", request_id: "r" } });
    }
    if (pathname.endsWith("/residuals.svg")) return route.fulfill({ contentType: "image/svg+xml", body: '<svg xmlns="http://www.w3.org/2000/svg" width="20" height="20"/>' });
    if (pathname.endsWith("/calibrations") && route.request().method() === "POST") return route.fulfill({ status: 202, json: { job: kCalibrate } });
    if (pathname.endsWith("/calibrations")) return route.fulfill({ json: { calibrations: this.#calibrations, damaged: [] } });
    return route.fulfill({ json: pathname.endsWith("/scanners") ? { scanners: [record] } : record });
  }

  get #calibrations() {
    return this.state === "done" ? [{ number: 1, created: "2026-01-01T00:01:00Z", camera: "GV01", rms: 0.02, p95: 0.04, max: 0.09, coverage: 0.8 }] : [];
  }

  #job(route) {
    const { pathname } = new URL(route.request().url());
    if (pathname.endsWith("/resume") && ++this.pose === this.poses) this.state = "done";
    if (pathname.endsWith("/events")) return route.fulfill({ contentType: "text/event-stream", body: `event: job\ndata: ${JSON.stringify(this.job)}\n\n` });
    return route.fulfill({ status: route.request().method() === "GET" ? 200 : 202, json: this.job });
  }
}
