// SPDX-License-Identifier: Apache-2.0
// Sends requests through nginx, as the public does, and repeats each until a response arrives.
import { once } from "node:events";
import https from "node:https";
import { setTimeout as pause } from "node:timers/promises";

const kPause = 100; // time between attempts, in ms

export class Visitor {
  /** Connects to nginx at `url`; `ca` is its certificate. */
  constructor(url, ca, token) {
    Object.assign(this, { url, ca, token, agent: new https.Agent({ keepAlive: true, ca }) });
  }

  /** Sends a request once. Returns the response, whatever its status, or undefined if none arrives. */
  async try(method, path, { headers = {}, body } = {}) {
    const fields = { ...(this.token && { Authorization: `Bearer ${this.token}` }), ...headers };
    const request = https.request(this.url + path, { method, headers: fields, agent: this.agent, timeout: 15_000 });
    request.on("timeout", () => request.destroy(new Error("no answer")));
    request.end(body);
    try {
      const [response] = await once(request, "response");
      return { status: response.statusCode, headers: response.headers, body: Buffer.concat(await response.toArray()) };
    } catch {
      return undefined;
    }
  }

  /** Repeats a request until a response arrives that is neither a server error (5xx) nor 429. Returns this response. */
  async ask(method, path, more) {
    for (;;) {
      const answer = await this.try(method, path, more);
      if (answer && answer.status < 500 && answer.status !== 429) return answer;
      await pause(kPause);
    }
  }

  async json(method, path, body, headers = {}) {
    const fields = { ...headers, ...(body && { "Content-Type": "application/json" }) };
    const answer = await this.ask(method, `/api/v1${path}`, { headers: fields, body: body && JSON.stringify(body) });
    return { status: answer.status, body: answer.body.length > 0 ? JSON.parse(answer.body) : undefined };
  }

  close() {
    this.agent.destroy();
  }
}
