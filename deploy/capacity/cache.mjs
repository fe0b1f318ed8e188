// SPDX-License-Identifier: Apache-2.0
// A cache as nginx has one: the least recently used goes first, files take whole blocks of the disk,
// and room is made by a manager that looks now and then, not at each request.
const kBlock = 4096, kHeader = 1024;  // bytes; nginx keeps the answer's header in the same file

/** What a chunk of `bytes` takes of the cache's room. */
export function room(bytes) {
  return Math.ceil((bytes + kHeader) / kBlock) * kBlock;
}

export class DiskCache {
  #files = new Map();  // the least recently used first
  #used = 0;

  constructor(capacity) {
    this.capacity = capacity;
  }

  /** Whether `key` was there; it is afterwards. */
  ask(key, bytes) {
    const size = this.#files.get(key);
    this.#files.delete(key);
    this.#files.set(key, size ?? room(bytes));
    if (size === undefined) this.#used += this.#files.get(key);
    return size !== undefined;
  }

  /** What the manager does when it looks. */
  makeRoom() {
    for (const [key, size] of this.#files) {
      if (this.#used < this.capacity) return;
      this.#files.delete(key);
      this.#used -= size;
    }
  }
}

/** What of `looks` at `models` the cache answers and what it asks its origin for. A look's head always
 *  reaches the origin, a stream does whole. The manager looks after each `managed` chunk requests. */
export function serve(looks, models, cache, managed) {
  const first = [0];  // numbers of the models' first chunks
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
