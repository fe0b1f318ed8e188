// SPDX-License-Identifier: Apache-2.0
// Who turns a scanner's table by hand, by way of the replicas that serve.
import { setTimeout as pause } from "node:timers/promises";
import { note } from "./timeline.mjs";

const kPatience = 3_000; // ms for an answer

export class Technician {
  /** `replicas` are asked in turn. */
  constructor(replicas, token) {
    Object.assign(this, { replicas, token, turns: 0, stopped: false });
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
