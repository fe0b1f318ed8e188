// SPDX-License-Identifier: Apache-2.0
import { scanState, size, timeLeft } from "@ui/texts/index.ts";

test.each([
  [0, "a few seconds left"],
  [9.9, "a few seconds left"],
  [44, "less than a minute left"],
  [45, "about a minute left"],
  [89, "about a minute left"],
  [90, "about 2 minutes left"],
  [3500, "about 58 minutes left"],
  [3590, "about an hour left"],
  [5400, "about 2 hours left"],
])("%s seconds are %s", (seconds, words) => expect(timeLeft(seconds)).toBe(words));

test.each([
  [null, null, "Scanning"],
  [null, "camera 1 is gone; check its cable", "Scanning: camera 1 is gone; check its cable"],
  ["no stripe; place the object", null, "Scanning: no stripe; place the object"],
])("a scan with error %s and note %s is described as %s", (error, note, words) =>
  expect(scanState({ state: "scanning", error, note })).toBe(words));

test.each([
  [999, "999 B"],
  [1500, "1.5 KB"],
  [2_340_000, "2.3 MB"],
])("%s bytes are %s", (bytes, words) => expect(size(bytes)).toBe(words));
