// SPDX-License-Identifier: Apache-2.0
// The daemon's public interface, called with an operator's token, which is sent as Bearer and nowhere else.
import { eventData } from "./events.ts";
import { Problem } from "./problem.ts";
import type { Job } from "./types.ts";

const kRoot = "/api/v1";
/** Milliseconds after which nobody answers any more; devices may take their time. */
const kPatience = 60_000;

interface Call {
  method?: string;
  body?: unknown;
  headers?: Record<string, string>;
  signal?: AbortSignal;
  endless?: boolean; // the answer goes on for as long as its matter
}

export class Api {
  /** The token is not in force (any more). */
  onRefused: (problem: Problem) => void = () => undefined;
  #rest = new AbortController(); // of all calls but stops
  readonly #unanswered = new Map<string, string>(); // keys of what may have begun

  constructor(readonly token: string) {}

  get headers(): Record<string, string> {
    return { Authorization: `Bearer ${this.token}` };
  }

  async get<T>(path: string, signal?: AbortSignal): Promise<T> {
    return (await (await this.#ask(path, signal ? { signal } : {})).json()) as T;
  }

  /** What is read, with the tag of its state. */
  async tagged<T>(path: string, signal: AbortSignal): Promise<{ value: T; tag: string }> {
    const answer = await this.#ask(path, { signal });
    return { value: (await answer.json()) as T, tag: answer.headers.get("ETag") ?? "" };
  }

  /** With a `tag` only if that is still the state of what is changed. */
  async send<T>(method: string, path: string, body?: unknown, tag?: string): Promise<T> {
    const answer = await this.#ask(path, { method, body, headers: tag ? { "If-Match": tag } : {} });
    return (answer.status === 204 ? undefined : await answer.json()) as T;
  }

  /** Begins something. Sent again after an answer that got lost it does not begin it twice. */
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

  /** x, y and z in mm of a scan's points from number `from` on: no more than one answer holds. */
  async points(scan: string, from: number, signal: AbortSignal): Promise<Float32Array> {
    const bytes = await (await this.#ask(`/scans/${scan}/points?from=${from}`, { signal })).arrayBuffer();
    return new Float32Array(bytes, 0, 3 * Math.floor(bytes.byteLength / 12));
  }

  /** A job as it is now and whenever it has changed, to its end. */
  async *follow(job: string, signal: AbortSignal): AsyncGenerator<Job> {
    const { body } = await this.#ask(`/jobs/${job}/events`, { signal, endless: true });
    if (body) for await (const data of eventData(body)) yield JSON.parse(data) as Job;
  }

  /**
   * Emergency stop. A browser grants few connections to a server: all that hold one are let go, and
   * ask again by themselves.
   */
  async stop(scanner: string): Promise<void> {
    this.#rest.abort(new DOMException("an emergency stop has priority", "AbortError"));
    this.#rest = new AbortController();
    const path = `${kRoot}/scanners/${scanner}/stop`;
    const answer = await fetch(path, { method: "POST", headers: this.headers, priority: "high", keepalive: true } as RequestInit);
    if (!answer.ok) throw await Problem.of(answer);
  }

  async #ask(path: string, { method = "GET", body, headers = {}, signal, endless = false }: Call): Promise<Response> {
    const json = body === undefined ? {} : { "Content-Type": "application/json" };
    const ends = [this.#rest.signal, ...(signal ? [signal] : []), ...(endless ? [] : [AbortSignal.timeout(kPatience)])];
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

/** `crypto.randomUUID` is not for pages without TLS. */
function newKey(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}
