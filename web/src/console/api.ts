// SPDX-License-Identifier: Apache-2.0
// Client of the daemon's API for operators. Each request carries the operator's token as a bearer
// token.
import { eventData } from "./events.ts";
import { Problem } from "./problem.ts";
import type { Job, Scanner } from "./types.ts";

const kRoot = "/api/v1";
/** Timeout of a request in milliseconds. It is long, because devices can be slow. */
const kTimeout = 60_000;

interface RequestOptions {
  method?: string;
  body?: unknown;
  headers?: Record<string, string>;
  signal?: AbortSignal;
  isEndless?: boolean; // whether the request has no timeout, because its response ends only when a job ends
}

export class Api {
  /** Called when the daemon rejects the token, for example because the token was revoked. */
  onRefused: (problem: Problem) => void = () => undefined;
  #rest = new AbortController(); // aborts all requests except emergency stops
  // Idempotency keys of the requests that have no response yet. The map's key is path and body.
  readonly #unanswered = new Map<string, string>();

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

  /** Sends a change. With a `tag`, the daemon applies the change only if the resource still has this entity tag. */
  async send<T>(method: string, path: string, body?: unknown, tag?: string): Promise<T> {
    const answer = await this.#ask(path, { method, body, headers: tag ? { "If-Match": tag } : {} });
    return (answer.status === 204 ? undefined : await answer.json()) as T;
  }

  /** Like send(), and also resolves to the new entity tag of the resource. */
  async sendTagged<T>(method: string, path: string, body: unknown, tag: string): Promise<{ value: T; tag: string }> {
    const answer = await this.#ask(path, { method, body, headers: { "If-Match": tag } });
    return { value: (await answer.json()) as T, tag: answer.headers.get("ETag") ?? "" };
  }

  /**
   * Starts a job. If the response gets lost, repeat the same call: it reuses the idempotency key,
   * so the job is not started twice.
   */
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

  /**
   * Returns x, y and z in mm of a scan's points, starting at point number `from`. One response may
   * contain only some of the points.
   */
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
   * Sends an emergency stop and returns the scanner's state. First aborts all other requests, because browsers limit the number of
   * connections to a server.
   */
  async stop(scanner: string): Promise<Scanner> {
    this.#rest.abort(new DOMException("an emergency stop has priority", "AbortError"));
    this.#rest = new AbortController();
    const path = `${kRoot}/scanners/${scanner}/stop`;
    const answer = await fetch(path, { method: "POST", headers: this.headers, priority: "high", keepalive: true } as RequestInit);
    if (!answer.ok) throw await Problem.of(answer);
    return (await answer.json()) as Scanner;
  }

  /**
   * Switches a laser off, even while the browser leaves the page. Ignores errors, because the
   * daemon switches the laser off by itself after a minute.
   */
  putOut(scanner: string): void {
    const headers = { ...this.headers, "Content-Type": "application/json" };
    void fetch(`${kRoot}/scanners/${scanner}/laser`, { method: "POST", headers, body: '{"on":false}', keepalive: true }).catch(() => undefined);
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
