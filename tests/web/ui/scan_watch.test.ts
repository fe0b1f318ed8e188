// SPDX-License-Identifier: Apache-2.0
import { ApiError, type ScanRecord, type ScanState } from "@ui/api.ts";
import { watchScan, type ScanSight, type ScanSource } from "@ui/scan-watch.ts";

const record: ScanRecord = {
  id: "a", state: "scanning", step: 1, steps: 2, progress: 0.5, eta: null, error: null, note: null, points: 0, model: null, title: "",
};

/** A fake scan. Each request for its record gets the next of `answers`: a state, a record or an error. */
class Script implements ScanSource {
  readonly asked: number[] = [];
  constructor(private readonly answers: (ScanState | Partial<ScanRecord> | Error)[], private readonly slices: number[] = []) {}

  async scan(): Promise<ScanRecord> {
    const answer = this.answers.shift();
    if (answer === undefined) throw new Error("asked after the end");
    if (answer instanceof Error) throw answer;
    return { ...record, ...(typeof answer === "string" ? { state: answer } : answer) };
  }

  async points(from: number): Promise<Float32Array> {
    this.asked.push(from);
    return new Float32Array(3 * (this.slices.shift() ?? 0));
  }
}

class Diary implements ScanSight {
  readonly lines: string[] = [];
  show = ({ state }: ScanRecord) => void this.lines.push(state);
  restart = () => void this.lines.push("restart");
  grow = (points: Float32Array) => void this.lines.push(`+${points.length / 3}`);
  lost = () => void this.lines.push("lost");
  missing = () => void this.lines.push("missing");
}

async function watched(script: Script) {
  const diary = new Diary(), pauses: number[] = [];
  await watchScan(script, diary, async (milliseconds) => void pauses.push(milliseconds));
  return { lines: diary.lines, pauses };
}

const gone = () => new TypeError("network"), status = (code: number) => new ApiError("/", code);

describe("watchScan", () => {
  test("asks until the scan is done, and no more", async () => {
    const { lines, pauses } = await watched(new Script(["waiting", "scanning", "meshing", "building", "done"]));
    expect(lines).toEqual(["waiting", "scanning", "meshing", "building", "done"]);
    expect(pauses).toHaveLength(4);
  });

  test("asks for the points that it does not hold, before it tells how far the scan is", async () => {
    const script = new Script(["scanning", "scanning", "cancelled"], [10, 0, 5]);
    expect((await watched(script)).lines).toEqual(["+10", "scanning", "scanning", "+5", "cancelled"]);
    expect(script.asked).toEqual([0, 10, 10]);
  });

  test("asks on at once where an answer was full", async () => {
    const script = new Script(["done"], [250_000, 250_000, 7]);
    expect((await watched(script)).lines).toEqual(["+250000", "+250000", "+7", "done"]);
    expect(script.asked).toEqual([0, 250_000, 500_000]);
  });

  test("starts over where the scan has fewer points than before", async () => {
    const script = new Script([{ points: 10 }, { points: 4 }, { state: "cancelled", points: 9 }], [10, 4, 5]);
    expect((await watched(script)).lines).toEqual(["+10", "scanning", "restart", "+4", "scanning", "+5", "cancelled"]);
    expect(script.asked).toEqual([0, 0, 4]);
  });

  test("keeps points that came before the scan has told of them", async () => {
    const script = new Script([{ points: 4 }, { points: 8 }, { state: "cancelled", points: 12 }], [10, 0, 2]);
    expect((await watched(script)).lines).toEqual(["+10", "scanning", "scanning", "+2", "cancelled"]);
    expect(script.asked).toEqual([0, 10, 10]);
  });

  test("keeps points that are all that a scan has which told of more", async () => {
    const script = new Script([{ state: "failed", points: 10 }, { state: "cancelled", points: 4 }], [4]);
    expect((await watched(script)).lines).toEqual(["+4", "failed", "cancelled"]);
    expect(script.asked).toEqual([0, 4]);
  });

  test("asks for no points of what is a model already", async () => {
    const script = new Script([{ state: "done", model: "m" }], [10]);
    expect((await watched(script)).lines).toEqual(["done"]);
  });

  test("tries again, later and later, until it is answered", async () => {
    const faults = Array.from({ length: 7 }, gone);
    const { lines, pauses } = await watched(new Script([...faults, "scanning", gone(), "done"]));
    expect(lines).toEqual([...Array<string>(7).fill("lost"), "scanning", "lost", "done"]);
    expect(pauses).toEqual([1000, 2000, 4000, 8000, 16_000, 30_000, 30_000, 500, 1000]);
  });

  test.each([500, 503, 429, 408])("takes %s for a trouble that passes", async (code) => {
    expect((await watched(new Script([status(code), "done"]))).lines).toEqual(["lost", "done"]);
  });

  test.each([401, 403, 404])("takes %s for the last word", async (code) => {
    expect(await watched(new Script([status(code)]))).toEqual({ lines: ["missing"], pauses: [] });
  });

  test("keeps watching a scan that is paused or has failed, as it may be resumed", async () => {
    const { lines, pauses } = await watched(new Script(["paused", "failed", "scanning", "cancelled"]));
    expect(lines).toEqual(["paused", "failed", "scanning", "cancelled"]);
    expect(pauses).toEqual([2000, 10_000, 500]);
  });
});
