// SPDX-License-Identifier: Apache-2.0
import { Lending } from "@core/lending.ts";
import { settle } from "../support/fake_model.ts";

/**
 * Borrows all buffers. Returns them, and the promise of one more buffer, which resolves when a
 * buffer is returned.
 */
async function exhaust(lending: Lending): Promise<[ArrayBuffer[], Promise<ArrayBuffer | undefined>]> {
  const lent: ArrayBuffer[] = [];
  for (;;) {
    const next = lending.borrow();
    const got = await Promise.race([next, settle().then(() => "none")]);
    if (got === "none") return [lent, next];
    lent.push(got as ArrayBuffer);
  }
}

describe("Lending", () => {
  test("bounds what is on the way, and continues with what is returned", async () => {
    const lending = new Lending();
    const [lent, waiting] = await exhaust(lending);
    expect(new Set(lent).size).toBe(64);
    lending.giveBack([lent[5] as ArrayBuffer]);
    expect(await waiting).toBe(lent[5]);
    expect((await exhaust(lending))[0]).toEqual([]);
  });

  test("releases all waiting calls when it is closed", async () => {
    const lending = new Lending();
    const [, waiting] = await exhaust(lending);
    lending.close();
    expect(await waiting).toBeUndefined();
    expect(await lending.borrow()).toBeUndefined();
  });
});
