// SPDX-License-Identifier: Apache-2.0
// What has to hold of a cluster whatever happened to it. Each takes facts and returns the faults.

/** Of `orders` ({job, model, mesh}), those whose job has not ended in one model. */
export function unfinished(orders) {
  return orders.filter(({ model }) => !model).map(({ job }) => `job ${job} has made nothing`);
}

/** `history`: [model, file] for each time that the catalogue was told which file a model has. */
export function differentResults(history) {
  const files = new Map();
  for (const [model, file] of history) files.set(model, (files.get(model) ?? new Set()).add(file));
  return [...files].filter(([, named]) => named.size > 1).map(([model, named]) => `model ${model} was published as ${[...named].join(" and ")}`);
}

/** `ends`: the job of each time that one was told to be done. */
export function doneTwice(ends) {
  return ends.filter((job, i) => ends.indexOf(job) !== i).map((job) => `job ${job} was done twice`);
}

/** `models`: {id, sha256, expected} of the files that are served, and that a build of the same mesh makes. */
export function otherFiles(models) {
  return models.filter(({ sha256, expected }) => sha256 !== expected).map(({ id, sha256, expected }) => `model ${id} is ${sha256 ?? "gone"}, not ${expected}`);
}

/** `looks`: {model, statuses} of who asked for a model that was listed, and for parts of it; but for those
 *  that somebody has taken away. */
export function halfVisible(looks, deleted) {
  const torn = looks.filter(({ model, statuses }) => !deleted.has(model) && statuses.some((status) => status !== 200));
  return torn.map(({ model, statuses }) => `model ${model} was listed, and its parts are answered by ${statuses.join(", ")}`);
}

/** `models`: those of the catalogue; `orders` as above. */
export function unordered(models, orders, deleted) {
  const ordered = new Set(orders.map(({ model }) => model).filter((model) => !deleted.has(model)));
  const strange = models.filter((model) => !ordered.delete(model)).map((model) => `nobody has ordered model ${model}, or it was taken away`);
  return [...strange, ...[...ordered].map((model) => `model ${model} is gone`)];
}

/** `commands`: {at, holder, text} of who told a scanner's board what; `epochs`: {at, holder} of who took the
 *  scanner from then on, in their order. Whoever has it no more only switches it off. */
export function outOfEpoch(commands, epochs) {
  const driver = (at) => epochs.filter((epoch) => epoch.at <= at).at(-1)?.holder;
  const drives = commands.filter(({ text }) => /^(M17|M71|G1 X)/.test(text));
  return drives.filter(({ at, holder }) => driver(at) !== holder).map(({ at, holder, text }) => `${holder} says ${text} at ${at}, when ${driver(at)} drives`);
}

/** `named`: the files that the catalogue names; `stored`: the store's objects. */
export function collectedAlive(named, stored) {
  return named.filter((file) => !stored.includes(file)).map((file) => `${file} is gone from the store`);
}

/** `progress`: when something came to a viewer; `limit` in the same unit. */
export function lostSessions(progress, from, to, limit) {
  const marks = progress.filter((mark) => mark > from && mark < to);
  const gaps = [from, ...marks, to].slice(1).map((mark, i, all) => mark - (i === 0 ? from : all[i - 1]));
  return gaps.filter((gap) => gap > limit).map((gap) => `a viewer saw nothing for ${gap.toFixed(0)}`);
}
