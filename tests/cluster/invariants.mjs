// SPDX-License-Identifier: Apache-2.0
// Checks the invariants that a cluster must keep after any failure. Each function takes observations and returns a list
// of violations, each described by a text.

/** Reports the `orders` ({job, model, mesh}) whose job has not made a model. */
export function unfinished(orders) {
  return orders.filter(({ model }) => !model).map(({ job }) => `job ${job} has made nothing`);
}

/**
 * Reports models that were published with more than one file. `history` has an entry [model, file] for each time that
 * the catalogue recorded a model's file.
 */
export function differentResults(history) {
  const files = new Map();
  for (const [model, file] of history) files.set(model, (files.get(model) ?? new Set()).add(file));
  return [...files].filter(([, named]) => named.size > 1).map(([model, named]) => `model ${model} was published as ${[...named].join(" and ")}`);
}

/** Reports jobs that succeeded twice. `ends` names a job once for each time that the catalogue recorded its success. */
export function doneTwice(ends) {
  return ends.filter((job, i) => ends.indexOf(job) !== i).map((job) => `job ${job} was done twice`);
}

/**
 * Reports models whose file differs from the expected one. `models` is a list of {id, sha256, expected}, in which
 * `sha256` is the hash of the served file, or undefined if the file is not served.
 */
export function otherFiles(models) {
  return models.filter(({ sha256, expected }) => sha256 !== expected).map(({ id, sha256, expected }) => `model ${id} is ${sha256 ?? "gone"}, not ${expected}`);
}

/**
 * Reports models that were listed but incomplete. `looks` is a list of {model, statuses}: a listed model and the
 * statuses of the requests for its parts. Models in `deleted` are ignored.
 */
export function halfVisible(looks, deleted) {
  const torn = looks.filter(({ model, statuses }) => !deleted.has(model) && statuses.some((status) => status !== 200));
  return torn.map(({ model, statuses }) => `model ${model} was listed, and its parts are answered by ${statuses.join(", ")}`);
}

/**
 * Reports models that nobody ordered, and ordered models that are missing. `models` are the models in the catalogue,
 * and `orders` are the orders with their models. The models in `deleted` must be missing.
 */
export function unordered(models, orders, deleted) {
  const ordered = new Set(orders.map(({ model }) => model).filter((model) => !deleted.has(model)));
  const strange = models.filter((model) => !ordered.delete(model)).map((model) => `nobody has ordered model ${model}, or it was deleted`);
  return [...strange, ...[...ordered].map((model) => `model ${model} is gone`)];
}

/**
 * Reports commands from daemons that were not allowed to drive the scanner. `commands` lists all commands to the
 * scanner's board as {at, holder, text}. `epochs` lists all acquisitions of the scanner as {at, holder}, in order. A
 * daemon that has lost the scanner may only switch it off.
 */
export function outOfEpoch(commands, epochs) {
  const driver = (at) => epochs.filter((epoch) => epoch.at <= at).at(-1)?.holder;
  const drives = commands.filter(({ text }) => /^(M17|M71|G1 X)/.test(text));
  return drives.filter(({ at, holder }) => driver(at) !== holder).map(({ at, holder, text }) => `${holder} says ${text} at ${at}, when ${driver(at)} drives`);
}

/** Reports files that the catalogue names (`named`) but that are no longer among the store's objects (`stored`). */
export function collectedAlive(named, stored) {
  return named.filter((file) => !stored.includes(file)).map((file) => `${file} is gone from the store`);
}

/**
 * Reports periods between `from` and `to` in which a viewer received no data for longer than `limit`. `progress` lists
 * the times at which the viewer received data. All values are in milliseconds.
 */
export function lostSessions(progress, from, to, limit) {
  const marks = progress.filter((mark) => mark > from && mark < to);
  const gaps = [from, ...marks, to].slice(1).map((mark, i, all) => mark - (i === 0 ? from : all[i - 1]));
  return gaps.filter((gap) => gap > limit).map((gap) => `a viewer saw nothing for ${gap.toFixed(0)}`);
}
