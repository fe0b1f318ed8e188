// SPDX-License-Identifier: Apache-2.0
// Simulates visitors. A visitor opens a random number of models, chosen by Zipf's law, and looks at
// each model for a random time. The connections of visitors have different speeds.

/** Returns a generator of random numbers from 0 to 1 (mulberry32). The same seed always gives the same numbers. */
export function chance(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/**
 * Returns `count` models. Each model is a list of its chunks' sizes in bytes, coarsest chunk first.
 * The models have about `bytes` bytes on average. The largest possible model is nine times as large
 * as the smallest. Each chunk has `chunkBytes` bytes.
 */
export function catalogue({ count, bytes, chunkBytes }, random) {
  const mean = 8 / 3 / Math.log(9);  // the mean of 3 ** (2 x - 1) for x from 0 to 1
  return Array.from({ length: count }, () => {
    const chunks = Math.max(1, Math.round((bytes * 3 ** (2 * random() - 1)) / mean / chunkBytes));
    return Array(chunks).fill(chunkBytes);
  });
}

/**
 * Returns a function that picks an index from 0 to count - 1 at random by Zipf's law. Index r is
 * (r + 1) ** -exponent times as likely as index 0.
 */
function zipf(count, exponent, random) {
  const sums = new Float64Array(count);
  for (let rank = 0, sum = 0; rank < count; ++rank) sums[rank] = sum += (rank + 1) ** -exponent;
  return () => {
    const drawn = random() * sums[count - 1];
    let low = 0;
    for (let high = count - 1; low < high; ) {
      const middle = (low + high) >> 1;
      if (sums[middle] <= drawn) low = middle + 1;
      else high = middle;
    }
    return low;
  };
}

/**
 * Picks a connection at random from `lines`, a list of {share, bytesPerSecond}. A share is the
 * probability of the connection; the shares add up to 1.
 */
function line(lines, random) {
  let left = random();
  return lines.find(({ share }) => (left -= share) < 0) ?? lines.at(-1);
}

/**
 * Simulates `visits` visitors. Yields one record for each model that a visitor opens: the model,
 * how many of its chunks arrived, and whether they came over a stream. simulate.mjs describes the
 * members of `visitor`.
 */
export function* looks(models, visits, visitor, random) {
  const pick = zipf(models.length, visitor.exponent, random);
  for (let visit = 0; visit < visits; ++visit) {
    const { bytesPerSecond } = line(visitor.lines, random);
    do {
      const model = pick();
      const bytes = -Math.log(1 - random()) * visitor.seconds * bytesPerSecond;
      yield { visit, model, chunks: chunksWithin(models[model], bytes), streamed: random() < visitor.streams };
    } while (random() < 1 - 1 / visitor.looks);
  }
}

function chunksWithin(chunks, bytes) {
  let count = 0;
  while (count < chunks.length && bytes > 0) bytes -= chunks[count++];
  return count;
}
