// SPDX-License-Identifier: Apache-2.0
// Client of the daemon's API with an operator's token, which is sent as a bearer token only.
import { eventData } from "./events.ts";
import { Problem } from "./problem.ts";
import type { Job } from "./types.ts";

const kRoot = "/api/v1";
/** Timeout of a request, in milliseconds; long, because devices can be slow. */
const kTimeout = 60_000;

interface RequestOptions {
  method?: string;
  body?: unknown;
  headers?: Record<string, string>;
  signal?: AbortSignal;
  isEndless?: boolean; // whether the request has no timeout, because its response ends only when a job ends
}

export class Api {
  /** Called when the daemon rejects the token, for example after it was revoked. */
  onRefused: (problem: Problem) => void = () => undefined;
  #rest = new AbortController(); // controller that can abort all requests except emergency stops
  readonly #unanswered = new Map<string, string>(); // idempotency keys of requests without a response, by path and body

  constructor(readonly token: string) {}

  get headers(): Record<string, string> {
    return { Authorization: `Bearer ${this.token}` };
  }

  async get<T>(path: string, signal?: AbortSignal): Promise<T> {
    return (await (await this.#ask(path, signal ? { signal } : {})).json()) as T;
  }

  /** Requests `path`. Returns the response's JSON as `value`, and its entity tag. */
  async tagged<T>(path: string, signal: AbortSignal): Promise<{ value: T; tag: string }> {
    const answer = await this.#ask(path, { signal });
    return { value: (await answer.json()) as T, tag: answer.headers.get("ETag") ?? "" };
  }

  /** Sends a change. With a `tag`, the daemon applies it only if the resource still has this entity tag. */
  async send<T>(method: string, path: string, body?: unknown, tag?: string): Promise<T> {
    const answer = await this.#ask(path, { method, body, headers: tag ? { "If-Match": tag } : {} });
    return (answer.status === 204 ? undefined : await answer.json()) as T;
  }

  /** Starts a job. If the response gets lost, the same call reuses its idempotency key, so that the job is not started twice. */
  async begin<T>(path: string, body: unknown): Promise<T> {
    const order = path + JSON.stringify(body), key = this.#unanswered.get(order) ?? newKey();
    this.#unanswered.set(order, key);
    try {
      const answer = await this.#ask(path, { method: "POST", body, headers: { "Idempotency-Key": key } });
      this.#unanswered.delete(order);
      return (await answer.json()) as T;
    } catch (error) {
      if (error instanceof Problem) this.#unanswered.delete(order);
      throw error;
    }
  }

  async blob(path: string, signal: AbortSignal): Promise<Blob> {
    return (await this.#ask(path, { signal })).blob();
  }

  /** Returns x, y and z in mm of a scan's points from point number `from` on, as many as fit into one response. */
  async points(scan: string, from: number, signal: AbortSignal): Promise<Float32Array> {
    const bytes = await (await this.#ask(`/scans/${scan}/points?from=${from}`, { signal })).arrayBuffer();
    return new Float32Array(bytes, 0, 3 * Math.floor(bytes.byteLength / 12));
  }

  /** Yields the current state of a job and every later state, until the job ends. */
  async *follow(job: string, signal: AbortSignal): AsyncGenerator<Job> {
    const { body } = await this.#ask(`/jobs/${job}/events`, { signal, isEndless: true });
    if (body) for await (const data of eventData(body)) yield JSON.parse(data) as Job;
  }

  /**
   * Sends an emergency stop. First aborts all other requests, because browsers limit the number of connections per
   * server.
   */
  async stop(scanner: string): Promise<void> {
    this.#rest.abort(new DOMException("an emergency stop has priority", "AbortError"));
    this.#rest = new AbortController();
    const path = `${kRoot}/scanners/${scanner}/stop`;
    const answer = await fetch(path, { method: "POST", headers: this.headers, priority: "high", keepalive: true } as RequestInit);
    if (!answer.ok) throw await Problem.of(answer);
  }

  async #ask(path: string, { method = "GET", body, headers = {}, signal, isEndless = false }: RequestOptions): Promise<Response> {
    const json = body === undefined ? {} : { "Content-Type": "application/json" };
    const ends = [this.#rest.signal, ...(signal ? [signal] : []), ...(isEndless ? [] : [AbortSignal.timeout(kTimeout)])];
    const answer = await fetch(kRoot + path, {
      method,
      headers: { ...this.headers, ...json, ...headers },
      body: body === undefined ? null : JSON.stringify(body),
      signal: AbortSignal.any(ends),
      cache: "no-store",
    });
    if (answer.ok) return answer;
    const problem = await Problem.of(answer);
    if (answer.status === 401) this.onRefused(problem);
    throw problem;
  }
}

/** Creates an idempotency key. `crypto.randomUUID` is not available on pages without TLS. */
function newKey(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}
