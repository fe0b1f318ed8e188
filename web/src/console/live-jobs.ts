// SPDX-License-Identifier: Apache-2.0
// Keeps the states of the jobs up to date. Browsers allow only six connections to a server.
// Therefore only a few jobs are followed as event streams; the other jobs are polled.
import { isOver, type Job, type JobListPage } from "./types.ts";

const kFollowed = 2;
/** Number of jobs that are polled. These are the newest jobs. */
const kListed = 50;
/** Polling interval in milliseconds. */
const kPause = 3000;

export interface JobSource {
  get<T>(path: string, signal?: AbortSignal): Promise<T>;
  follow(job: string, signal: AbortSignal): AsyncIterable<Job>;
}

type Listener = () => void;

export class LiveJobs {
  readonly #jobs = new Map<string, Job>();
  readonly #followed = new Map<string, AbortController>();
  readonly #watched: string[] = []; // IDs of the jobs on the open page, which are followed first
  readonly #listeners = new Set<Listener>();

  constructor(private readonly source: JobSource) {}

  /** All known jobs, newest first. */
  get all(): Job[] {
    return [...this.#jobs.values()].sort((a, b) => (a.id < b.id ? 1 : -1)); // IDs are ordered by time
  }

  /** Keeps the jobs up to date until `signal` is aborted. */
  async run(signal: AbortSignal): Promise<void> {
    signal.addEventListener("abort", () => this.#followed.forEach((one) => one.abort()));
    while (!signal.aborted) {
      // Ignores an error, because the next poll follows soon.
      if (!document.hidden) await this.refresh().catch(() => undefined);
      await new Promise((resolve) => setTimeout(resolve, kPause));
    }
  }

  async refresh(): Promise<void> {
    const { jobs } = await this.source.get<JobListPage>(`/jobs?limit=${kListed}`);
    for (const job of jobs) this.#jobs.set(job.id, job);
    this.#follow();
    this.#tell();
  }

  onChange(listener: Listener, signal: AbortSignal): void {
    this.#listeners.add(listener);
    signal.addEventListener("abort", () => this.#listeners.delete(listener));
    listener();
  }

  /** Calls `see` with the current state of a job and with each later state, until `signal` is aborted. */
  async watch(id: string, see: (job: Job) => void, signal: AbortSignal): Promise<void> {
    this.#watched.unshift(id);
    signal.addEventListener("abort", () => this.#watched.splice(this.#watched.indexOf(id), 1));
    let seen = "";
    this.onChange(() => {
      const now = this.#jobs.get(id), state = JSON.stringify(now);
      if (!now || state === seen) return; // each poll creates the job's object again
      seen = state;
      see(now);
    }, signal);
    this.put(await this.source.get<Job>(`/jobs/${id}`, signal));
  }

  put(job: Job): void {
    this.#jobs.set(job.id, job);
    this.#follow();
    this.#tell();
  }

  #tell(): void {
    for (const listener of [...this.#listeners]) listener();
  }

  /** Follows the jobs that have the highest priority, and stops following all other jobs. */
  #follow(): void {
    const wanted = this.#mostWanted();
    for (const [id, one] of this.#followed) if (!wanted.includes(id)) one.abort();
    for (const id of wanted) if (!this.#followed.has(id)) void this.#listen(id);
  }

  #mostWanted(): string[] {
    const open = this.all.filter((job) => !isOver(job));
    const rank = ({ id, state }: Job) => (this.#watched.includes(id) ? 0 : state === "running" ? 1 : 2);
    return open.sort((a, b) => rank(a) - rank(b)).slice(0, kFollowed).map(({ id }) => id);
  }

  /** Follows a job until the job ends, a job of higher priority replaces it, or the connection is lost. */
  async #listen(id: string): Promise<void> {
    const end = new AbortController();
    this.#followed.set(id, end);
    try {
      for await (const job of this.source.follow(id, end.signal)) {
        this.#jobs.set(id, job);
        this.#tell();
      }
    } catch {
      // Ignores an error, because the next poll gets the job's state.
    } finally {
      this.#followed.delete(id);
    }
  }
}
