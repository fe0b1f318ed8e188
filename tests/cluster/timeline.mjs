// SPDX-License-Identifier: Apache-2.0
// Records notes on the test's actions and the cluster's reactions, each with its time, to explain a failure.
const kStart = performance.now();
const lines = [];

export function note(text) {
  lines.push(`${((performance.now() - kStart) / 1000).toFixed(3).padStart(8)} s  ${text}`);
}

export function timeline() {
  return lines.join("\n");
}
