// SPDX-License-Identifier: Apache-2.0
// Tests that each check in invariants.mjs reports violations in faulty observations, and none in correct ones.
import assert from "node:assert/strict";
import { test } from "node:test";
import * as invariants from "./invariants.mjs";

test("a job that has made nothing", () => {
  assert.deepEqual(invariants.unfinished([{ job: "a", model: "m" }]), []);
  assert.equal(invariants.unfinished([{ job: "a", model: "m" }, { job: "b" }]).length, 1);
});

test("a model that was published as two files", () => {
  assert.deepEqual(invariants.differentResults([["m", "1"], ["m", "1"], ["n", "2"]]), []);
  assert.match(invariants.differentResults([["m", "1"], ["n", "1"], ["m", "2"]]).join(), /model m .* 1 and 2/);
});

test("a job that was done twice", () => {
  assert.deepEqual(invariants.doneTwice(["a", "b"]), []);
  assert.equal(invariants.doneTwice(["a", "b", "a"]).length, 1);
});

test("a file that is another one, or gone", () => {
  assert.deepEqual(invariants.otherFiles([{ id: "m", sha256: "1", expected: "1" }]), []);
  assert.equal(invariants.otherFiles([{ id: "m", sha256: "2", expected: "1" }, { id: "n", expected: "1" }]).length, 2);
});

test("a model that is listed before it is there", () => {
  const looks = [{ model: "m", statuses: [200, 200] }, { model: "n", statuses: [200, 404] }];
  assert.match(invariants.halfVisible(looks, new Set()).join(), /^model n .* 200, 404$/);
  assert.deepEqual(invariants.halfVisible(looks, new Set(["n"])), []);
});

test("a model that nobody has ordered, and one that is gone", () => {
  const orders = [{ model: "m" }, { model: "n" }];
  assert.deepEqual(invariants.unordered(["m"], orders, new Set(["n"])), []);
  assert.match(invariants.unordered(["m", "n", "o"], orders, new Set()).join(), /^nobody .* o,/);
  assert.match(invariants.unordered(["m", "m", "n"], orders, new Set()).join(), /^nobody .* m,/);
  assert.match(invariants.unordered(["m"], orders, new Set()).join(), /^model n is gone$/);
});

test("a scanner that is driven by who drove it before", () => {
  const epochs = [{ at: 1, holder: "a" }, { at: 5, holder: "b" }];
  const said = (at, holder, text) => ({ at, holder, text });
  const good = [said(1, "a", "M17"), said(4, "a", "G1 X3.0000 F200"), said(6, "a", "M70T1"), said(6, "b", "M71T1"), said(9, "a", "?")];
  assert.deepEqual(invariants.outOfEpoch(good, epochs), []);
  assert.deepEqual(invariants.outOfEpoch([said(6, "a", "G1 X3.0000 F200")], epochs), ["a says G1 X3.0000 F200 at 6, when b drives"]);
  assert.equal(invariants.outOfEpoch([said(0, "a", "M71T1"), said(4, "b", "M17")], epochs).length, 2);
});

test("an object that was collected though a model names it", () => {
  assert.deepEqual(invariants.collectedAlive(["1"], ["1", "2"]), []);
  assert.match(invariants.collectedAlive(["1", "3"], ["1", "2"]).join(), /^3 is gone/);
});

test("a viewer that saw nothing for too long, up to the end, too", () => {
  assert.deepEqual(invariants.lostSessions([1, 4, 8, 11], 0, 12, 5), []);
  assert.equal(invariants.lostSessions([1, 7, 11], 0, 12, 5).length, 1);
  assert.equal(invariants.lostSessions([1, 4], 0, 12, 5).length, 1);
  assert.equal(invariants.lostSessions([], 0, 12, 5).length, 1);
});
