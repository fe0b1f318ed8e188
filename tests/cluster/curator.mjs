// SPDX-License-Identifier: Apache-2.0
// Simulates an operator who uploads scans, publishes models of them and deletes some, while parts of the cluster fail.
import { setTimeout as pause } from "node:timers/promises";
import { note } from "./timeline.mjs";

const kTus = { "Tus-Resumable": "1.0.0" };
const kOpenJobs = 4; // maximum number of jobs at a time

export class Curator {
  /**
   * Uses `meshes` ({obj, isBrief}) in turn. The model of a mesh with `isBrief` is deleted as soon as it exists.
   * Garbage collection may therefore remove the model's file just when the next model of the same mesh needs the same
   * file.
   */
  constructor(visitor, meshes) {
    Object.assign(this, { visitor, meshes, orders: [], deleted: new Set(), stopped: false });
  }

  /** Runs until stop() is called. Throws if the server breaks its contract. */
  async work() {
    const open = new Set();
    for (let i = 0; !this.stopped; ++i) {
      const order = await this.#order(i);
      const end = this.#end(order).then(() => open.delete(end));
      open.add(end);
      if (open.size >= kOpenJobs) await Promise.race(open);
    }
    await Promise.all(open);
  }

  stop() {
    this.stopped = true;
  }

  async #order(number) {
    const mesh = number % this.meshes.length;
    const upload = await this.#upload(this.meshes[mesh].obj);
    const request = { upload, publish: true, metadata: { title: `Model ${number}` } };
    const { status, body } = await this.visitor.json("POST", "/models", request, { "Idempotency-Key": `order-${number}` });
    if (status !== 202) throw new Error(`an order gets status ${status}: ${JSON.stringify(body)}`);
    const order = { number, mesh, job: body.job };
    note(`order ${number} is job ${body.job}`);
    this.orders.push(order);
    return order;
  }

  async #upload(bytes) {
    const made = await this.visitor.ask("POST", "/api/v1/uploads", { headers: { ...kTus, "Upload-Length": bytes.length } });
    if (made.status !== 201) throw new Error(`an upload gets status ${made.status}: ${made.body}`);
    const path = made.headers.location.replace(/^https?:\/\/[^/]+/, "");
    for (let sent = 0; sent < bytes.length;) {
      const headers = { ...kTus, "Upload-Offset": sent, "Content-Type": "application/offset+octet-stream" };
      await this.visitor.try("PATCH", path, { headers, body: bytes.subarray(sent) });
      const { status, headers: now } = await this.visitor.ask("HEAD", path, { headers: kTus });
      if (status !== 200) throw new Error(`an upload is gone: ${status}`);
      sent = Number(now["upload-offset"]);
    }
    return path.split("/").pop();
  }

  async #end(order) {
    while (!order.model) {
      await pause(200);
      const { status, body } = await this.visitor.json("GET", `/jobs/${order.job}`);
      if (status !== 200 || body.state === "failed") throw new Error(`job ${order.job}: ${status} ${JSON.stringify(body)}`);
      if (body.state === "done") order.model = body.model;
    }
    note(`order ${order.number} is model ${order.model}`);
    if (!this.meshes[order.mesh].isBrief || this.stopped) return;
    this.deleted.add(order.model);
    await this.visitor.json("DELETE", `/models/${order.model}`);
  }
}
