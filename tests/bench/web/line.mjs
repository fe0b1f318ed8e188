// SPDX-License-Identifier: Apache-2.0
// Simulates a slow line: a relay on loopback that delays bytes in both directions. The server's
// bytes arrive at a limited rate, which all connections share fairly. A new connection takes a
// round trip, as with TCP.
import { once } from "node:events";
import { connect, createServer } from "node:net";

const kPacket = 1448;
/** Bytes of one connection that the relay queues before the server has to pause. */
const kQueue = 65536;

export class Line {
  /**
   * Starts a line to a server at `port` on this machine. `rate` is in bytes per second, `delay` in
   * ms per direction.
   */
  static async to(port, { rate, delay }) {
    const line = new Line(port, rate, delay);
    line.server.listen(0, "127.0.0.1");
    await once(line.server, "listening");
    line.url = `http://127.0.0.1:${line.server.address().port}`;
    return line;
  }

  #waiting = []; // connections as { server, client, packets }, served in turn
  #free = 0; // time in ms when the next packet may leave
  #timer;

  constructor(port, rate, delay) {
    Object.assign(this, { port, rate, delay });
    this.server = createServer((client) => this.#open(client));
  }

  stop() {
    clearTimeout(this.#timer);
    this.server.close();
  }

  #open(client) {
    const server = connect(this.port, "127.0.0.1"), packets = [], established = performance.now() + 2 * this.delay;
    for (const socket of [client, server]) socket.setNoDelay(true).on("error", () => [client, server].forEach((end) => end.destroy()));
    const later = (act) => setTimeout(act, Math.max(0, established - performance.now()) + this.delay);
    client.on("data", (bytes) => later(() => server.writable && server.write(bytes)));
    client.on("close", () => server.destroy());
    server.on("data", (bytes) => {
      for (let at = 0; at < bytes.length; at += kPacket) packets.push(bytes.subarray(at, at + kPacket));
      if (packets.length * kPacket > kQueue) server.pause();
      if (!this.#waiting.some((one) => one.packets === packets)) this.#waiting.push({ server, client, packets });
      this.#pump();
    });
    server.on("close", () => setTimeout(() => client.end(), 2 * this.delay));
  }

  #pump() {
    clearTimeout(this.#timer);
    const now = performance.now();
    // Lets late packets catch up by at most 5 ms, which compensates for late timers but not for
    // idle time.
    this.#free = Math.max(this.#free, now - 5);
    while (this.#waiting.length > 0 && this.#free <= now) {
      const one = this.#waiting.shift(), packet = one.packets.shift();
      this.#free += (1000 * packet.length) / this.rate;
      setTimeout(() => one.client.writable && one.client.write(packet), this.delay);
      if (one.packets.length > 0) this.#waiting.push(one);
      if (one.packets.length * kPacket < kQueue) one.server.resume();
    }
    if (this.#waiting.length > 0) this.#timer = setTimeout(() => this.#pump(), this.#free - now);
  }
}
