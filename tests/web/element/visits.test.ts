// SPDX-License-Identifier: Apache-2.0
import { Visit } from "@element/tools/visits.ts";

describe("a visit", () => {
  test("is reported with the whole seconds in view and the finest level", () => {
    const visit = new Visit();
    visit.show(true, 1_000);
    visit.reach(2);
    visit.reach(1);
    visit.show(false, 3_900);
    expect(visit.report(9_000)).toBe("seconds=2&level=2");
  });

  test("that lasts less than a second is a visit, too", () => {
    const visit = new Visit();
    visit.show(true, 0);
    expect(visit.report(300)).toBe("seconds=0&level=0");
  });

  test("is not reported if the model was never in view", () => {
    const visit = new Visit();
    visit.show(false, 0);
    visit.reach(3);
    expect(visit.report(60_000)).toBeUndefined();
  });

  test("continues after a report, which keeps the rest of a second", () => {
    const visit = new Visit();
    visit.show(true, 0);
    expect(visit.report(1_600)).toBe("seconds=1&level=0");
    visit.reach(4);
    expect(visit.report(2_100)).toBe("seconds=1&level=4&previous=0");
    expect(visit.report(2_500)).toBeUndefined();
    visit.show(false, 3_000);
    visit.show(true, 50_000);
    expect(visit.report(51_100)).toBe("seconds=2&level=4&previous=4");
  });

  test("states at most a day in one report", () => {
    const visit = new Visit();
    visit.show(true, 0);
    expect(visit.report(90_000_000)).toBe("seconds=86400&level=0");
    expect(visit.report(90_000_000)).toBe("seconds=3600&level=0&previous=0");
  });
});
