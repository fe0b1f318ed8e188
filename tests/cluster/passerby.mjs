// SPDX-License-Identifier: Apache-2.0
// Simulates a visitor who opens the newest models of the gallery, and requests the manifest and one chunk of each.
import { setTimeout as pause } from "node:timers/promises";

export class Passerby {
  /** `random` is a function that returns random numbers from 0 to 1. The numbers choose the chunks. */
  constructor(visitor, random) {
    Object.assign(this, { visitor, random, looks: [], stopped: false });
  }

  async stroll() {
    for (; !this.stopped; await pause(100)) {
      const { body: { models } } = await this.visitor.json("GET", "/models?limit=3");
      for (const { id } of models) this.looks.push(await this.#look(id));
    }
  }

  stop() {
    this.stopped = true;
  }

  async #look(model) {
    const { status, body } = await this.visitor.json("GET", `/models/${model}/manifest`);
    if (status !== 200) return { model, statuses: [status] };
    const { sha256 } = body.chunks[Math.floor(this.random() * body.chunks.length)];
    const chunk = await this.visitor.ask("GET", `/api/v1/chunks/${sha256}`);
    return { model, statuses: [status, chunk.status] };
  }
}
