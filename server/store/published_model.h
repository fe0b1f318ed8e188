// SPDX-License-Identifier: Apache-2.0
// Models as visitors see them. A model is stored once, as its .pmesh file: the head is the file's
// first bytes and a chunk is a range of it, so that nothing is on the disk twice and each request
// is one sendfile(2) from a descriptor that is already open.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <shared_mutex>
#include <unordered_map>

#include "codec/progressive/manifest.h"
#include "server/catalogue/catalogue.h"
#include "server/store/object_store.h"

namespace vitrine {

struct ByteRange {
  std::uint64_t offset = 0, length = 0;
};

// What has been told of a model, kept to be told again.
struct Document {
  std::string text, etag;
};

// Immutable. Holds its file open; keep the shared pointer for as long as bytes are being sent.
class PublishedModel {
 public:
  // Fails with kState where the object is missing or is not the file that the record describes.
  static Expected<std::shared_ptr<const PublishedModel>> open(const ObjectStore& store,
                                                              ModelRecord record);

  const ModelRecord& record() const { return record_; }
  const Manifest& manifest() const { return manifest_; }
  const Object& file() const { return *file_; }
  ByteRange whole() const { return {0, manifest_.file_bytes}; }
  ByteRange head() const { return {0, manifest_.head_bytes()}; }
  ByteRange base() const { return {manifest_.base_offset, manifest_.base_length}; }
  ByteRange chunk(std::size_t index) const {
    return {manifest_.chunks[index].offset, manifest_.chunks[index].length};
  }
  // Where the chunk or the base of that name lies; nothing where it has none.
  std::optional<ByteRange> find(const Sha256& sha256) const;
  Expected<std::vector<std::uint8_t>> read(ByteRange range) const {
    return file_->read(range.offset, range.length);
  }

  // Its manifest in the form that the API tells it in. Null before keep_manifest(). Thread-safe.
  std::shared_ptr<const Document> kept_manifest() const { return std::atomic_load(&told_); }
  void keep_manifest(Document document) const {
    std::atomic_store(&told_, std::make_shared<const Document>(std::move(document)));
  }

 private:
  PublishedModel() = default;

  ModelRecord record_;
  Manifest manifest_;
  std::unique_ptr<Object> file_;
  mutable std::shared_ptr<const Document> told_;
};

struct PublishedChunk {
  std::shared_ptr<const PublishedModel> model;  // null where there is no such chunk
  ByteRange range;
};

// The published models of an installation, opened on first use and kept. Thread-safe. What another
// process publishes is found at once; what it changes or hides is noticed within `staleness`.
class PublishedModels {
 public:
  PublishedModels(const ObjectStore& store, Catalogue& catalogue,
                  std::chrono::milliseconds staleness = std::chrono::milliseconds(100))
      : store_(store), catalogue_(catalogue), staleness_(staleness) {}

  // What is public of it. Null where there is no such model or it is a draft.
  Expected<std::shared_ptr<const PublishedModel>> find(const ModelId& id);

  // All of a model, drafts too, for those who may see it: opened anew each time. Null where there
  // is none.
  Expected<std::shared_ptr<const PublishedModel>> open_whole(const ModelId& id);

  // What this process has published or hidden is so from the next call on.
  void refresh();

  // The model or the chunk where it is in memory and known to be current. Waits for neither
  // catalogue nor disk. Now and then nothing though it is there: whoever gets that asks the
  // catalogue, for all.
  std::shared_ptr<const PublishedModel> held(const ModelId& id);
  std::optional<PublishedChunk> held_chunk(const Sha256& sha256);

  // A chunk or a base mesh of any published model.
  Expected<PublishedChunk> find_chunk(const Sha256& sha256);

 private:
  struct HashOfHash {
    std::size_t operator()(const Sha256& sha256) const noexcept;
  };
  struct HashOfId {
    std::size_t operator()(const ModelId& id) const noexcept;
  };
  using Clock = std::chrono::steady_clock;

  bool is_fresh(Clock::time_point now, Clock::duration age) const;  // with the lock held
  bool may_show(Clock::time_point now);                             // likewise
  Expected<void> forget_if_changed();
  Expected<std::shared_ptr<const PublishedModel>> load(const ModelId& id);
  void remember(const std::shared_ptr<const PublishedModel>& model, std::uint64_t revision);

  const ObjectStore& store_;
  Catalogue& catalogue_;
  const std::chrono::milliseconds staleness_;

  std::shared_mutex mutex_;  // guards what follows
  std::uint64_t revision_ = 0;
  Clock::time_point checked_{};
  std::atomic<Clock::rep> due_{0};  // when somebody is to ask the catalogue again
  std::uint64_t refreshed_ = 0;     // how often: what was read before is no news
  std::unordered_map<ModelId, std::shared_ptr<const PublishedModel>, HashOfId> models_;
  std::unordered_map<Sha256, PublishedChunk, HashOfHash> chunks_;
};

}  // namespace vitrine
