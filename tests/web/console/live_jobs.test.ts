// SPDX-License-Identifier: Apache-2.0
import { LiveJobs, type JobSource } from "@console/live-jobs.ts";
import type { Job, JobState } from "@console/types.ts";

const job = (id: string, state: JobState): Job => ({
  id, state, kind: "publish", stage: null, progress: 0, eta: null, error: null, note: null, scanner: null, scan: null, model: null, repairs: [], created: "", ended: null,
});

/** A fake daemon. `open.get(id).tell(state)` sends a state on the event stream of the job `id`. */
class Played implements JobSource {
  readonly open = new Map<string, { tell: (next: Job) => void; signal: AbortSignal }>();
  constructor(public jobs: Job[]) {}

  async get<T>(path: string): Promise<T> {
    const one = this.jobs.find(({ id }) => path === `/jobs/${id}`);
    return (path.startsWith("/jobs?") ? { jobs: this.jobs, next: null } : one) as T;
  }

  async *follow(id: string, signal: AbortSignal): AsyncGenerator<Job> {
    const waiting: Job[] = [];
    let wake = () => {};
    this.open.set(id, { signal, tell: (next) => (waiting.push(next), wake()) });
    signal.addEventListener("abort", () => wake());
    try {
      while (!signal.aborted) {
        await new Promise<void>((resolve) => (wake = resolve));
        yield* waiting.splice(0);
      }
    } finally {
      this.open.delete(id);
    }
  }
}

const turn = () => new Promise((resolve) => setImmediate(resolve));
const never = new AbortController().signal;

test("few are followed, those at work before those that wait", async () => {
  const source = new Played([job("4", "queued"), job("3", "done"), job("2", "running"), job("1", "running")]), jobs = new LiveJobs(source);
  await jobs.refresh();
  await turn();
  expect([...source.open.keys()].sort()).toEqual(["1", "2"]);
  expect(jobs.all.map(({ id }) => id)).toEqual(["4", "3", "2", "1"]);
});

test("the one that a page shows comes first", async () => {
  const source = new Played([job("3", "queued"), job("2", "running"), job("1", "running")]), jobs = new LiveJobs(source);
  await jobs.refresh();
  await jobs.watch("3", () => undefined, never);
  await turn();
  expect(source.open.has("3")).toBe(true);
  expect(source.open.size).toBe(2);
});

test("each change is seen once, and nothing after the page is left", async () => {
  const source = new Played([job("1", "running")]), jobs = new LiveJobs(source), seen: number[] = [], left = new AbortController();
  await jobs.watch("1", ({ progress }) => seen.push(progress), left.signal);
  await turn();
  source.open.get("1")?.tell({ ...job("1", "running"), progress: 0.5 });
  await turn();
  left.abort();
  source.open.get("1")?.tell({ ...job("1", "running"), progress: 0.7 });
  await turn();
  expect(seen).toEqual([0, 0.5]);
  expect(jobs.all[0]?.progress).toBe(0.7);
});

test("a job that has not changed since the last poll is not seen again", async () => {
  const source = new Played([job("1", "done")]), jobs = new LiveJobs(source), seen: JobState[] = [];
  await jobs.watch("1", ({ state }) => seen.push(state), never);
  source.jobs = [job("1", "done")]; // an equal object, as from the next response
  await jobs.refresh();
  expect(seen).toEqual(["done"]);
});

test("a job that has ended makes room for the next", async () => {
  const source = new Played([job("3", "queued"), job("2", "running"), job("1", "running")]), jobs = new LiveJobs(source);
  await jobs.refresh();
  await turn();
  source.jobs = [job("3", "running"), job("2", "done"), job("1", "running")];
  await jobs.refresh();
  await turn();
  expect([...source.open.keys()].sort()).toEqual(["1", "3"]);
});
