// SPDX-License-Identifier: Apache-2.0
import { sentence } from "@console/forms.ts";
import { Problem } from "@console/problem.ts";
import { stageName } from "@console/texts/index.ts";

test.each([
  ["building", "Building the model"],
  ["place the target, pose 3 of 20", "Place the target: pose 3 of 20"],
  ["something new", "something new"],
])("the stage %s is %s", (stage, words) => expect(stageName(stage)).toBe(words));

test.each([
  [new Problem(409, "Conflict", "the scanner is busy; wait for its end"), "The scanner is busy; wait for its end"],
  [new Problem(500, "Internal Server Error"), /^The server failed/],
  [new Problem(502, "Bad Gateway"), /^The server failed/],
  [new Problem(404, "Not Found"), /404 Not Found/],
  [new TypeError("Failed to fetch"), /does not respond/],
  [new DOMException("", "TimeoutError"), /does not respond/],
  [new DOMException("", "AbortError"), /emergency stop/],
])("%s is reported with the next step", (error, words) => expect(sentence(error)).toMatch(words));

test("a proxy's page has nothing to tell but its status", async () => {
  const problem = await Problem.of(new Response("<html>", { status: 413, statusText: "Payload Too Large" }));
  expect(problem).toMatchObject({ status: 413, title: "Payload Too Large", detail: "", faults: [] });
});
