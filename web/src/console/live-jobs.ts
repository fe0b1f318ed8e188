// SPDX-License-Identifier: Apache-2.0
// The jobs as they are now. A browser grants six connections to a server, so few are followed as
// they change; of the others it is asked now and then.
import { isOver, type Job, type JobPage } from "./types.ts";

const kFollowed = 2;
/** Of the newest. */
const kListed = 50;
/** Milliseconds between two questions. */
const kPause = 3000;

export interface JobSource {
  get<T>(path: string, signal?: AbortSignal): Promise<T>;
  follow(job: string, signal: AbortSignal): AsyncIterable<Job>;
}

type Listener = () => void;

export class LiveJobs {
  readonly #jobs = new Map<string, Job>();
  readonly #followed = new Map<string, AbortController>();
  readonly #watched: string[] = []; // by the page that is open: they come first
  readonly #listeners = new Set<Listener>();

  constructor(private readonly source: JobSource) {}

  /** Newest first. */
  get all(): Job[] {
    return [...this.#jobs.values()].sort((a, b) => (a.id < b.id ? 1 : -1)); // ids tell the time
  }

  /** Keeps them live until `signal`. */
  async run(signal: AbortSignal): Promise<void> {
    signal.addEventListener("abort", () => this.#followed.forEach((one) => one.abort()));
    while (!signal.aborted) {
      if (!document.hidden) await this.refresh().catch(() => undefined); // the next question is near
      await new Promise((resolve) => setTimeout(resolve, kPause));
    }
  }

  async refresh(): Promise<void> {
    const { jobs } = await this.source.get<JobPage>(`/jobs?limit=${kListed}`);
    for (const job of jobs) this.#jobs.set(job.id, job);
    this.#follow();
    this.#tell();
  }

  onChange(listener: Listener, signal: AbortSignal): void {
    this.#listeners.add(listener);
    signal.addEventListener("abort", () => this.#listeners.delete(listener));
    listener();
  }

  /** A job of which the page has just learned, or which it shows. */
  async watch(id: string, see: (job: Job) => void, signal: AbortSignal): Promise<void> {
    this.#watched.unshift(id);
    signal.addEventListener("abort", () => this.#watched.splice(this.#watched.indexOf(id), 1));
    let seen: Job | undefined;
    this.onChange(() => {
      const now = this.#jobs.get(id);
      if (now && now !== seen) see((seen = now));
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

  /** Those that matter most, and no others. */
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

  /** Until it is over, another is wanted more, or the connection is lost: then the next question finds it. */
  async #listen(id: string): Promise<void> {
    const end = new AbortController();
    this.#followed.set(id, end);
    try {
      for await (const job of this.source.follow(id, end.signal)) {
        this.#jobs.set(id, job);
        this.#tell();
      }
    } catch {
      // the next question finds it
    } finally {
      this.#followed.delete(id);
    }
  }
}
