// SPDX-License-Identifier: Apache-2.0
// Polls a scan until it has ended. Reports its state, its new points, and lost connections.
import { ApiError, type ScanRecord, type ScanState } from "./api.ts";

export interface ScanSource {
  scan(): Promise<ScanRecord>;
  points(from: number): Promise<Float32Array>;
}

export interface ScanSight {
  show(scan: ScanRecord): void;
  restart(): void; // called when all points so far are invalid; the scan's valid points follow
  grow(points: Float32Array): void;
  lost(): void; // called when the server does not respond; the request is sent again
  missing(): void; // called if the scan does not exist or is not public
}

/** Maximum number of points in one response. */
const kFull = 250_000;
/**
 * Polling interval, in milliseconds, for each state of a scan. A scan in any other state has ended
 * and is not polled.
 */
const kPause: Partial<Record<ScanState, number>> = {
  waiting: 1000, scanning: 500, paused: 2000, meshing: 500, building: 500,
  failed: 10_000, // polled, because an operator may resume a failed scan
};
const kFirstRetry = 1000, kLongestRetry = 30_000;

export type PollDelay = (milliseconds: number) => Promise<void>;
const sleep: PollDelay = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

export async function watchScan(source: ScanSource, sight: ScanSight, wait: PollDelay = sleep): Promise<void> {
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

/**
 * Polls the scan once and returns its state. Fetches new points before it shows the state, so that
 * all points are visible when the scan ends.
 */
async function look(source: ScanSource, sight: ScanSight, growth: Growth): Promise<ScanState> {
  const scan = await source.scan();
  if (scan.model === null) await growth.follow(scan.points);
  sight.show(scan);
  return scan.state;
}

class Growth {
  #held = 0;
  #reported = 0; // number of points in the last scan record; more may be available by now

  constructor(private readonly source: ScanSource, private readonly sight: ScanSight) {}

  /**
   * Fetches new points. Fetches all points again if `reported` is lower than before, because the
   * scan has then restarted.
   */
  async follow(reported: number): Promise<void> {
    if (reported < Math.min(this.#held, this.#reported)) this.#restart();
    this.#reported = reported;
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

/** Whether a request that failed with `error` would fail again. */
function isFinal(error: unknown): boolean {
  return error instanceof ApiError && error.status >= 400 && error.status < 500 && error.status !== 408 && error.status !== 429;
}
