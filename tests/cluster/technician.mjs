// SPDX-License-Identifier: Apache-2.0
// Who scans at a scanner, and turns its table by hand, by way of the replicas that serve.
import { setTimeout as pause } from "node:timers/promises";
import { note } from "./timeline.mjs";

const kPatience = 3_000; // ms for an answer
const kSteps = 48; // of a scan
const kPoses = 12; // of a calibration

export class Technician {
  /** `replicas` are asked in turn; what is ordered is by `visitor`. */
  constructor(replicas, visitor) {
    Object.assign(this, { replicas, visitor, token: visitor.token, turns: 0, scans: [], stopped: false });
  }

  /** From when a daemon has taken the scanner. */
  async calibrate() {
    while ((await this.visitor.json("GET", "/scanners/rig")).status !== 200) await pause(100);
    const { status, body } = await this.visitor.json("POST", "/scanners/rig/calibrations", { poses: kPoses }, { "Idempotency-Key": "calibration" });
    if (status !== 202) throw new Error(`a calibration is answered by ${status}: ${JSON.stringify(body)}`);
    await this.#until(`/jobs/${body.job}`, ({ state }) => state === "done");
  }

  /** Begins a scan; what it is called, {id, job}. */
  async scan() {
    const number = this.scans.length;
    const wish = { scanner: "rig", steps: kSteps, publish: true, metadata: { title: `Scan ${number}` } };
    const { status, body } = await this.visitor.json("POST", "/scans", wish, { "Idempotency-Key": `scan-${number}` });
    if (status !== 202) throw new Error(`a scan is answered by ${status}: ${JSON.stringify(body)}`);
    note(`scan ${number} is ${body.id}, job ${body.job}`);
    this.scans.push(body);
    return body;
  }

  /** Until it has so many steps, and is not at its end. */
  async measured({ id }, steps) {
    const scan = await this.#until(`/scans/${id}`, ({ step }) => step >= steps);
    if (scan.step === kSteps) throw new Error("the scan is over before anybody dies");
  }

  /** Until it has ended in a model of a whole turn. */
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

  /** Until the table has been turned so often from now on. */
  async turned(times) {
    for (const wanted = this.turns + times; this.turns < wanted;) await pause(100);
  }

  async #jog({ url }) {
    const headers = { Authorization: `Bearer ${this.token}`, "Content-Type": "application/json" };
    const signal = AbortSignal.timeout(kPatience);
    const answer = await fetch(`${url}/api/v1/scanners/rig/jog`, { method: "POST", headers, body: '{"degrees": 30}', signal }).catch(() => undefined);
    await answer?.text().catch(() => undefined);
    return answer?.status;
  }
}
