// SPDX-License-Identifier: Apache-2.0
// Who comes and what they look at: popularity by Zipf's law, as many models a visit as chance has it,
// each for a while, over lines of several speeds.

/** Numbers from 0 to 1, the same for the same seed (mulberry32). */
export function chance(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** `count` models of `bytes` each on average, between a third and three times that, in chunks of about
 *  `chunkBytes`. A model is the list of its chunks' bytes, the coarsest first. */
export function catalogue({ count, bytes, chunkBytes }, random) {
  const mean = 8 / 3 / Math.log(9);  // of what 3 ** (2 x - 1) is for x from 0 to 1
  return Array.from({ length: count }, () => {
    const chunks = Math.max(1, Math.round((bytes * 3 ** (2 * random() - 1)) / mean / chunkBytes));
    return Array(chunks).fill(chunkBytes);
  });
}

/** Draws an index from 0 to count - 1; that of rank r is (r + 1) ** -exponent as likely as the first. */
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

/** Draws one of `lines`, {share, bytesPerSecond}; shares add up to 1. */
function line(lines, random) {
  let left = random();
  return lines.find(({ share }) => (left -= share) < 0) ?? lines.at(-1);
}

/** The looks of `visits` visits, in their order: which model, how many of its chunks came, and whether
 *  over a stream. `visitor`: {exponent, looks, seconds, streams, lines}; looks and seconds are means. */
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
