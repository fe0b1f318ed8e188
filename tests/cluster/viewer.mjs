// SPDX-License-Identifier: Apache-2.0
// Simulates a viewer that refines one model over the stream. When a connection ends, it continues on a new one. When
// the model is complete, it starts again from the beginning.
import { createHash, randomBytes } from "node:crypto";
import { once } from "node:events";
import https from "node:https";
import { setTimeout as pause } from "node:timers/promises";

const kHeader = 16; // bytes of a slice's header (server/stream/PROTOCOL.md)
const kPace = 60; // ms before a slice is acknowledged, so that refining takes a while

export class Viewer {
  /** Views the model `id`, which has this `manifest`, through the nginx to which `visitor` connects. */
  constructor(visitor, id, manifest) {
    Object.assign(this, { visitor, id, manifest, stopped: false, connections: 0, rounds: 0, resumed: 0 });
    this.progress = [performance.now()]; // times in ms at which data was received
    this.#forget();
  }

  #forget() {
    this.held = new Set();
    this.parts = new Map();
  }

  async watch() {
    while (!this.stopped) {
      await this.#session().catch(() => undefined);
      await pause(100);
    }
  }

  stop() {
    this.stopped = true;
    this.socket?.destroy();
  }

  async #session() {
    const headers = { Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Protocol": "pmesh.v1",
                      "Sec-WebSocket-Key": randomBytes(16).toString("base64") };
    const request = https.get(`${this.visitor.url}/api/v1/models/${this.id}/stream`, { headers, ca: this.visitor.ca, agent: false, timeout: 5_000 });
    request.on("timeout", () => request.destroy(new Error("no answer")));
    request.on("response", () => request.destroy(new Error("refused")));
    const [, socket, first] = await once(request, "upgrade");
    this.socket = socket;
    socket.on("error", () => undefined);
    ++this.connections;
    this.resumed += this.held.size > 0;
    this.parts.clear();
    this.#say({ type: "have", chunks: [...this.held].sort((a, b) => a - b).map((index) => [index, index]) });
    this.#want();
    let bytes = this.#frames(first);
    socket.on("data", (more) => (bytes = this.#frames(Buffer.concat([bytes, more]))));
    await once(socket, "close");
  }

  #want() {
    this.#say({ type: "want", level: this.manifest.levels.length - 1 });
  }

  #say(message) {
    const text = Buffer.from(JSON.stringify(message)), mask = randomBytes(4);
    const length = text.length < 126 ? [0x80 | text.length] : [0x80 | 126, text.length >> 8, text.length & 255];
    this.socket.write(Buffer.concat([Buffer.from([0x81, ...length]), mask, text.map((byte, i) => byte ^ mask[i % 4])]));
  }

  /** Processes the complete frames in `bytes`; returns the remaining bytes. */
  #frames(bytes) {
    for (;;) {
      if (bytes.length < 2) return bytes;
      const short = bytes[1] & 127, header = short === 126 ? 4 : 2;
      if (bytes.length < header) return bytes;
      const end = header + (short === 126 ? bytes.readUInt16BE(2) : short);
      if (bytes.length < end) return bytes;
      this.#frame(bytes[0] & 15, bytes.subarray(header, end));
      bytes = bytes.subarray(end);
    }
  }

  #frame(kind, payload) {
    if (kind === 8) this.socket.end();
    if (kind === 2) this.#slice(payload);
    if (kind === 1 && JSON.parse(payload).type === "done") this.#whole();
  }

  #slice(payload) {
    const level = payload.readUInt16LE(2), region = payload.readUInt32LE(4), length = payload.readUInt32LE(12);
    const index = this.manifest.chunks.findIndex((chunk) => chunk.level === level && chunk.region === region);
    const parts = this.parts.get(index) ?? [];
    parts.push(payload.subarray(kHeader));
    this.parts.set(index, parts);
    this.progress.push(performance.now());
    setTimeout(() => this.socket.writable && this.#say({ type: "ack", bytes: payload.length - kHeader }), kPace);
    const chunk = Buffer.concat(parts);
    if (chunk.length < length) return;
    const sha256 = createHash("sha256").update(chunk).digest("hex");
    if (sha256 !== this.manifest.chunks[index].sha256) this.fault = `chunk ${index} has another SHA-256`;
    this.held.add(index);
    this.parts.delete(index);
  }

  #whole() {
    ++this.rounds;
    this.#forget();
    this.socket.end(); // makes the server forget the chunks that this connection reported in `have`
  }
}
