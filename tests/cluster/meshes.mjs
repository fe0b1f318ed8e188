// SPDX-License-Identifier: Apache-2.0
import { chance } from "../../deploy/capacity/visitors.mjs";

/** Returns an OBJ file of 2 (side - 1)² triangles: a relief that differs for each `number`. */
export function relief(number, side) {
  const random = chance(number + 1), lines = [];
  for (let i = 0; i < side * side; ++i) lines.push(`v ${i % side} ${Math.floor(i / side)} ${(3 * random()).toFixed(3)}`);
  for (let i = 0; i < side * (side - 1); ++i) {
    if (i % side < side - 1) lines.push(`f ${i + 1} ${i + 2} ${i + side + 2}`, `f ${i + 1} ${i + side + 2} ${i + side + 1}`);
  }
  return Buffer.from(lines.join("\n"));
}
