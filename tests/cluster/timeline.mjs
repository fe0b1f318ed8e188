// SPDX-License-Identifier: Apache-2.0
// What was done to the cluster and what it said, in its order, for whoever has to explain a fault.
const kStart = performance.now();
const lines = [];

export function note(text) {
  lines.push(`${((performance.now() - kStart) / 1000).toFixed(3).padStart(8)} s  ${text}`);
}

export function timeline() {
  return lines.join("\n");
}
