// SPDX-License-Identifier: Apache-2.0
import { completeLevel, nextLevel, Throughput } from "@element/quality.ts";

const level = (faces: number, maxError: number) => ({ vertices: faces / 2, faces, maxError, rmsError: 0, cumulativeBytes: 10 * faces });
const model = { levels: [level(100, 4), level(200, 2), level(400, 1)] };

test.each([[0, 0], [99, 0], [100, 1], [150, 1], [399, 2], [400, undefined]])(
  "after %s triangles comes level %s", (triangles, next) => expect(nextLevel(model, triangles)).toBe(next));

test.each([[50, 4], [100, 4], [199, 4], [200, 2], [400, 1]])(
  "with %s triangles the error is %s", (triangles, error) => expect(completeLevel(model, triangles).maxError).toBe(error));

describe("a line", () => {
  test("promises nothing before it has been measured", () => {
    const line = new Throughput();
    line.sample(5000, 0);
    expect(line.secondsTo(5000)).toBe(0);
    expect(line.secondsTo(6000)).toBeUndefined();
  });

  test("is measured while bytes come in, not while it rests", () => {
    const line = new Throughput();
    line.sample(1000, 0);
    line.begin(60_000);
    line.sample(3000, 61_000); // 2000 bytes per second
    expect(line.secondsTo(9000)).toBeCloseTo(3);
  });

  test("does not count what is held already", () => {
    const line = new Throughput();
    line.begin(0);
    line.sample(2000, 1000);
    line.begin(5000);
    // A coarser state arrives, then the earlier state again. No bytes are downloaded for either of
    // them.
    line.sample(500, 5001);
    line.sample(2000, 5002);
    expect(line.held).toBe(2000);
    expect(line.secondsTo(4000)).toBeCloseTo(1);
  });

  test("follows a line that has become slow", () => {
    const line = new Throughput();
    line.begin(0);
    for (let i = 1; i <= 50; ++i) line.sample(1000 * i, 100 * i); // 10 kB/s
    for (let i = 1; i <= 20; ++i) line.sample(50_000 + 100 * i, 5000 + 1000 * i); // 0.1 kB/s
    expect(line.secondsTo(53_000)).toBeGreaterThan(5);
  });
});
