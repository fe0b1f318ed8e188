// SPDX-License-Identifier: Apache-2.0
// Simulates an operator who scans and turns the table manually, through the replicas with the role "serve".
import { setTimeout as pause } from "node:timers/promises";
import { note } from "./timeline.mjs";

const kResponseTimeout = 3_000; // time limit of a request, in ms
const kSteps = 48; // number of turntable steps per scan
const kPoses = 12; // number of target poses per calibration

export class Technician {
  /** Sends manual commands to the `replicas` in turn, and other requests through `visitor`. */
  constructor(replicas, visitor) {
    Object.assign(this, { replicas, visitor, token: visitor.token, turns: 0, scans: [], stopped: false });
  }

  /** Waits until a daemon drives the scanner, then calibrates it. */
  async calibrate() {
    while ((await this.visitor.json("GET", "/scanners/rig")).status !== 200) await pause(100);
    const { status, body } = await this.visitor.json("POST", "/scanners/rig/calibrations", { poses: kPoses }, { "Idempotency-Key": "calibration" });
    if (status !== 202) throw new Error(`a calibration gets status ${status}: ${JSON.stringify(body)}`);
    await this.#until(`/jobs/${body.job}`, ({ state }) => state === "done");
  }

  /** Starts a scan; returns its {id, job}. */
  async scan() {
    const number = this.scans.length;
    const request = { scanner: "rig", steps: kSteps, publish: true, metadata: { title: `Scan ${number}` } };
    const { status, body } = await this.visitor.json("POST", "/scans", request, { "Idempotency-Key": `scan-${number}` });
    if (status !== 202) throw new Error(`a scan gets status ${status}: ${JSON.stringify(body)}`);
    note(`scan ${number} is ${body.id}, job ${body.job}`);
    this.scans.push(body);
    return body;
  }

  /** Waits until the scan has measured at least `steps` steps. Throws if the scan is then complete. */
  async measured({ id }, steps) {
    const scan = await this.#until(`/scans/${id}`, ({ step }) => step >= steps);
    if (scan.step === kSteps) throw new Error("the scan has ended before a daemon was killed");
  }

  /** Waits until the scan has made a model. Throws if the scan did not measure a whole revolution. */
  async scanned(scan) {
    const { step, model } = await this.#until(`/scans/${scan.id}`, ({ state }) => state === "done");
    if (step !== kSteps) throw new Error(`a scan is done after ${step} steps`);
    Object.assign(scan, { model });
  }

  async #until(path, is) {
    for (;; await pause(100)) {
      const { status, body } = await this.visitor.json("GET", path);
      if (status !== 200 || body.state === "failed") throw new Error(`${path}: ${status} ${JSON.stringify(body)}`);
      if (body.step !== this.step) note(`${path} is at step ${(this.step = body.step)}`);
      if (is(body)) return body;
    }
  }

  async work() {
    for (let i = 0; !this.stopped; ++i) {
      const status = await this.#jog(this.replicas[i % this.replicas.length]);
      if (status === 200) ++this.turns;
      if (status !== this.status) note(`the scanner's table: ${(this.status = status)}`);
      await pause(300);
    }
  }

  stop() {
    this.stopped = true;
  }

  /** Waits until work() has turned the table `times` more times. */
  async turned(times) {
    for (const wanted = this.turns + times; this.turns < wanted;) await pause(100);
  }

  async #jog({ url }) {
    const headers = { Authorization: `Bearer ${this.token}`, "Content-Type": "application/json" };
    const signal = AbortSignal.timeout(kResponseTimeout);
    const answer = await fetch(`${url}/api/v1/scanners/rig/jog`, { method: "POST", headers, body: '{"degrees": 30}', signal }).catch(() => undefined);
    await answer?.text().catch(() => undefined);
    return answer?.status;
  }
}
