// SPDX-License-Identifier: Apache-2.0
import { Budget } from "@core/budget.ts";

const a = {}, b = {}, c = {};
const amount = (triangles: number) => ({ triangles, bytes: 10 * triangles, texels: 100 * triangles });

describe("Budget", () => {
  test("has no end unless one is set", () => expect(new Budget().room(a)).toEqual({ triangles: Infinity, bytes: Infinity, texels: Infinity }));

  test("gives a model alone all of it", () => expect(new Budget(amount(100)).room(a)).toEqual(amount(100)));

  test("gives what others leave", () => {
    const budget = new Budget(amount(100));
    budget.hold(a, amount(10));
    expect(budget.room(b)).toEqual(amount(90));
  });

  test("gives nobody less than an equal share, whatever others hold", () => {
    const budget = new Budget(amount(90));
    budget.hold(a, amount(90));
    budget.hold(b, amount(5));
    expect(budget.room(c).triangles).toBe(55);
    expect(budget.room(b).triangles).toBe(45);
    expect(budget.room(a).triangles).toBe(85);
  });

  test("frees the share of a closed model", () => {
    const budget = new Budget(amount(100));
    budget.hold(a, amount(50));
    budget.release(a);
    expect(budget.room(b)).toEqual(amount(100));
  });
});
