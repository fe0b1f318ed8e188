// SPDX-License-Identifier: Apache-2.0
// Follows a scan until it is over: what it is asked, when, and what an answer or its absence means.
import { ApiError, type ScanRecord, type ScanState } from "./api.ts";

export interface ScanSource {
  scan(): Promise<ScanRecord>;
  points(from: number): Promise<Float32Array>;
}

export interface ScanSight {
  show(scan: ScanRecord): void;
  restart(): void; // the points so far are no longer the scan's; what it has comes next
  grow(points: Float32Array): void;
  lost(): void; // nobody answers; it is tried again
  missing(): void; // there is nothing to be seen here
}

/** The most points of one answer. */
const kFull = 250_000;
/** Milliseconds between two questions, by the scan's state; in other states it is over. */
const kPause: Partial<Record<ScanState, number>> = {
  waiting: 1000, scanning: 500, paused: 2000, meshing: 500, building: 500,
  failed: 10_000, // an operator may go on with it
};
const kFirstRetry = 1000, kLongestRetry = 30_000;

export type Wait = (milliseconds: number) => Promise<void>;
const sleep: Wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

export async function watchScan(source: ScanSource, sight: ScanSight, wait: Wait = sleep): Promise<void> {
  const growth = new Growth(source, sight);
  let retry = kFirstRetry;
  for (;;) {
    let pause: number | undefined;
    try {
      pause = kPause[await look(source, sight, growth)];
      retry = kFirstRetry;
      if (pause === undefined) return;
    } catch (error) {
      if (isFinal(error)) return sight.missing();
      sight.lost();
      pause = retry;
      retry = Math.min(2 * retry, kLongestRetry);
    }
    await wait(pause);
  }
}

/** Points first: what is said to be over has been seen whole. */
async function look(source: ScanSource, sight: ScanSight, growth: Growth): Promise<ScanState> {
  const scan = await source.scan();
  if (scan.model === null) await growth.follow(scan.points);
  sight.show(scan);
  return scan.state;
}

class Growth {
  #held = 0;
  #told = 0; // of the last record, which lags behind the points themselves

  constructor(private readonly source: ScanSource, private readonly sight: ScanSight) {}

  /** A scan that has fewer points than before measures again what it has given up. */
  async follow(told: number): Promise<void> {
    if (told < Math.min(this.#held, this.#told)) this.#restart();
    this.#told = told;
    for (let came = kFull; came === kFull; ) {
      const points = await this.source.points(this.#held);
      came = points.length / 3;
      this.#held += came;
      if (came !== 0) this.sight.grow(points);
    }
  }

  #restart(): void {
    this.#held = 0;
    this.sight.restart();
  }
}

/** Asked again, it would be answered alike. */
function isFinal(error: unknown): boolean {
  return error instanceof ApiError && error.status >= 400 && error.status < 500 && error.status !== 408 && error.status !== 429;
}
