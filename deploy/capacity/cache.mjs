// SPDX-License-Identifier: Apache-2.0
// Simulates nginx's disk cache, which removes the least recently used files first. Each file
// occupies whole disk blocks. Like nginx's cache manager, the simulation frees space at intervals,
// not at each request.

// Size of a disk block, and of the response header at the start of each cache file, in bytes.
const kBlock = 4096, kHeader = 1024;

/** Returns the disk space that a chunk of `bytes` occupies in the cache. */
export function room(bytes) {
  return Math.ceil((bytes + kHeader) / kBlock) * kBlock;
}

export class DiskCache {
  #files = new Map();  // size of each file, the least recently used file first
  #used = 0;

  constructor(capacity) {
    this.capacity = capacity;
  }

  /** Requests a file and caches it. Returns whether it was in the cache before. */
  ask(key, bytes) {
    const size = this.#files.get(key);
    this.#files.delete(key);
    this.#files.set(key, size ?? room(bytes));
    if (size === undefined) this.#used += this.#files.get(key);
    return size !== undefined;
  }

  /** Removes the least recently used files until the cache is below its capacity. Called at intervals. */
  makeRoom() {
    for (const [key, size] of this.#files) {
      if (this.#used < this.capacity) return;
      this.#files.delete(key);
      this.#used -= size;
    }
  }
}

/**
 * Simulates how visitors load `models` through the cache. Each element of `looks` is one model that
 * a visitor opens (looks() in visitors.mjs). Returns the number of looks, the numbers of chunks and
 * bytes that visitors requested, and how many of these chunks and bytes came from the origin.
 * Streams bypass the cache, so their bytes are counted separately. The cache manager runs after
 * every `managed` chunk requests.
 */
export function serve(looks, models, cache, managed) {
  const first = [0];  // number of each model's first chunk, counted over all models
  for (const chunks of models) first.push(first.at(-1) + chunks.length);
  const sum = { looks: 0, chunks: 0, bytes: 0, originChunks: 0, originBytes: 0, streamBytes: 0 };
  for (const { model, chunks, streamed } of looks) {
    ++sum.looks;
    for (let i = 0; i < chunks; ++i) {
      const bytes = models[model][i];
      if (streamed) sum.streamBytes += bytes;
      else serveChunk(sum, cache.ask(first[model] + i, bytes), bytes);
      if (!streamed && sum.chunks % managed === 0) cache.makeRoom();
    }
  }
  return sum;
}

function serveChunk(sum, held, bytes) {
  ++sum.chunks;
  sum.bytes += bytes;
  if (held) return;
  ++sum.originChunks;
  sum.originBytes += bytes;
}
