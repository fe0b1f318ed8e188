// SPDX-License-Identifier: Apache-2.0
// Models as visitors see them. A model is stored once, as its .pmesh file: the head is the file's
// first bytes and a chunk is a range of it, so that nothing is on the disk twice and each request
// is one sendfile(2) from a descriptor that is already open.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

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

 private:
  friend class PublishedModels;
  PublishedModel() = default;

  ModelRecord record_;
  Manifest manifest_;
  std::vector<std::uint32_t> by_name_;  // the chunks' indices
  std::unique_ptr<Object> file_;
  mutable std::shared_ptr<const Document> told_;
  mutable std::atomic<std::chrono::steady_clock::rep> asked_{0};  // when somebody last asked for it
};

struct PublishedChunk {
  std::shared_ptr<const PublishedModel> model;  // null where there is no such chunk
  ByteRange range;
};

// The models of an installation, opened on first use, by one for all who ask, and kept:
// their manifests, and what has been told of those, in `max_bytes` of memory, the least recently
// asked for dropped first. Thread-safe. What another process publishes is found at once; what it
// changes or hides is noticed within `staleness`, and all else is kept. While the catalogue is
// away, what is held is shown on for a quarter of an hour: nobody changes it there.
class PublishedModels {
 public:
  PublishedModels(const ObjectStore& store, Catalogue& catalogue,
                  std::chrono::milliseconds staleness = std::chrono::milliseconds(100),
                  std::uint64_t max_bytes = UINT64_MAX)
      : store_(store), catalogue_(catalogue), staleness_(staleness), max_bytes_(max_bytes) {}

  void set_capacity(std::uint64_t max_bytes);
  std::uint64_t bytes();  // held

  // Has `post` run what asks the catalogue for news, elsewhere and soon. Before that, held() and
  // held_chunk() send a visitor now and then. Call it before anybody asks for a model.
  using Post = std::function<void(std::function<void()> task)>;
  void refresh_by(Post post) { post_ = std::move(post); }

  // What is public of it. Null where there is no such model or it is a draft.
  Expected<std::shared_ptr<const PublishedModel>> find(const ModelId& id);

  // All of a model, drafts too, for those who may see it. Null where there is none.
  Expected<std::shared_ptr<const PublishedModel>> find_whole(const ModelId& id);

  // What this process has published or hidden is so from the next call on.
  void refresh();

  // Keeps what is told of the model's manifest as long as the model is held.
  void keep_manifest(const std::shared_ptr<const PublishedModel>& model, Document document);

  // The model or the chunk where it is in memory and known to be current. Waits for neither
  // catalogue nor disk.
  std::shared_ptr<const PublishedModel> held(const ModelId& id);
  std::shared_ptr<const PublishedModel> held_whole(const ModelId& id);
  std::optional<PublishedChunk> held_chunk(const Sha256& sha256);

  // A chunk or a base mesh of any published model.
  Expected<PublishedChunk> find_chunk(const Sha256& sha256);

  // Answers from memory, and models that had to be opened.
  std::atomic<std::uint64_t> hits{0}, misses{0};

 private:
  struct HashOfHash {
    std::size_t operator()(const Sha256& sha256) const noexcept;
  };
  // What is seen of a model: what is public, or all of it.
  struct View {
    ModelId id;
    bool is_whole = false;
    bool operator==(const View&) const = default;
  };
  struct HashOfView {
    std::size_t operator()(const View& view) const noexcept;
  };
  using Clock = std::chrono::steady_clock;
  using Model = std::shared_ptr<const PublishedModel>;
  struct Held {
    Model model;
    std::uint64_t bytes = 0;
  };
  using HeldModels = std::unordered_map<View, Held, HashOfView>;
  // A model that is being opened; of no use to who knows of a later change.
  struct Opening {
    std::uint64_t revision, refreshed;
    std::promise<Expected<Model>> promise = {};
    std::shared_future<Expected<Model>> result = promise.get_future().share();
  };

  bool is_fresh(Clock::time_point now, Clock::duration age) const;  // with the lock held
  bool may_show(Clock::time_point now);                             // likewise
  void count_hit(const PublishedModel& model, Clock::time_point now);
  bool may_go_on(Clock::time_point now) const;  // likewise
  Expected<void> forget_if_changed();
  Expected<void> ask_for_changes(Clock::time_point now);
  Expected<std::vector<const PublishedModel*>> unchanged(const std::vector<Model>& models);
  Model held(const View& view);
  Expected<Model> find(const View& view);
  Expected<Model> load(const View& view);
  Expected<Model> open(const View& view);
  Expected<Model> open_newest(const View& view);
  void remember(const View& view, const Model& model, std::uint64_t revision);
  void tell_chunks(const Model& model);                   // with the lock held
  HeldModels::iterator drop(HeldModels::iterator model);  // likewise
  void make_room();                                       // likewise

  const ObjectStore& store_;
  Catalogue& catalogue_;
  const std::chrono::milliseconds staleness_;
  Post post_;

  std::shared_mutex mutex_;  // guards what follows
  std::uint64_t revision_ = 0;
  Clock::time_point checked_{};
  Clock::time_point known_{};          // when the catalogue last told; {}: not since a refresh()
  std::atomic<Clock::rep> due_{0};     // when somebody is to ask the catalogue again
  std::atomic<Clock::rep> asking_{0};  // since when somebody asks it; 0: nobody does
  std::uint64_t refreshed_ = 0;        // how often: what was read before is no news
  std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;
  HeldModels models_;
  std::unordered_multimap<Sha256, PublishedChunk, HashOfHash>
      chunks_;  // of the public views, each its own
  std::unordered_map<View, std::shared_ptr<Opening>, HashOfView> openings_;
};

}  // namespace vitrine
