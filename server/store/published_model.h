// SPDX-License-Identifier: Apache-2.0
// Published models and their cache. A model is stored as one .pmesh file. Its head is the start of
// the file, and each chunk is a range of the file. Each request therefore needs one sendfile(2)
// from a descriptor that is already open.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <set>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include "codec/format/manifest.h"
#include "server/catalogue/catalogue.h"
#include "server/content/document.h"
#include "server/store/object_store.h"

namespace vitrine::server {

struct ByteRange {
  std::uint64_t offset = 0, length = 0;
};

// Returns a hash of the base mesh and all chunks. Two files with the same hash decode to the same
// levels, even if their units differ. Removing the finest levels from a file changes the hash.
Sha256 geometry_hash(const Manifest& manifest);

// A model that is open for reading. Immutable. Keeps its file open as long as it exists, so hold
// the shared pointer while bytes are being sent.
class PublishedModel {
 public:
  // Opens the file of `record`, which was found damaged `damages` times before. Fails with kState
  // if the object is missing or damaged, or does not match the record.
  static Expected<std::shared_ptr<const PublishedModel>> open(const ObjectStore& store,
                                                              ModelRecord record,
                                                              std::uint64_t damages = 0);

  const ModelRecord& record() const { return record_; }
  const Manifest& manifest() const { return manifest_; }
  const Object& file() const { return *file_; }
  ByteRange whole() const { return {0, manifest_.file_bytes}; }
  ByteRange head() const { return {0, manifest_.head_bytes()}; }
  ByteRange base() const { return {manifest_.base_offset, manifest_.base_length}; }
  ByteRange chunk(std::size_t index) const {
    return {manifest_.chunks[index].offset, manifest_.chunks[index].length};
  }
  // Returns the position of the block with that SHA-256 (file_blocks.h); nullopt if the model does
  // not have it.
  std::optional<ByteRange> find(const Sha256& sha256) const;
  Expected<std::vector<std::uint8_t>> read(ByteRange range) const {
    return file_->read(range.offset, range.length);
  }

  // Number of times that this process found the file or a local copy of it damaged, before it
  // opened this model.
  std::uint64_t damages() const { return damages_; }

  // Returns the manifest as JSON for the API, or null if PublishedModels::keep_manifest() has not
  // been called yet. Thread-safe.
  std::shared_ptr<const Document> kept_manifest() const { return std::atomic_load(&told_); }

 private:
  friend class PublishedModels;
  PublishedModel() = default;
  // Returns the error for a model whose file is damaged or missing.
  static Unexpected damaged(const ModelRecord& record, std::string_view why);
  static Expected<Manifest> read_manifest(const Object& file, const ModelRecord& record);

  ModelRecord record_;
  Manifest manifest_;
  std::vector<std::uint32_t> by_name_;  // indices of the chunks, sorted by SHA-256
  std::unique_ptr<Object> file_;
  std::uint64_t damages_ = 0;
  mutable std::shared_ptr<const Document> told_;
  mutable std::atomic<std::chrono::steady_clock::rep> asked_{0};  // time of the last request
};

// Changes whenever PublishedModels::find() may return another model or error than before: the
// catalogue's revision, and how often an intact file or a local copy was found damaged.
struct ModelsRevision {
  std::uint64_t catalogue = 0, damages = 0;
  bool operator==(const ModelsRevision&) const = default;
};

struct PublishedChunk {
  std::shared_ptr<const PublishedModel> model;  // null if no model has the chunk
  ByteRange range;
};

// A cache of the models of an installation. The first request for a model opens the model;
// concurrent requests wait for it. If the catalogue or the store cannot be read, the request fails,
// and so do further requests for the model during the next `staleness`, without another attempt.
// Keeps manifests and their JSON in at most `max_bytes` of memory, and drops the least recently
// used models first. Thread-safe. Finds a model as soon as another process has published it.
// Notices changes by other processes to cached models within `staleness`. While the catalogue is
// unreachable, serves cached models for up to 15 minutes.
class PublishedModels {
 public:
  PublishedModels(const ObjectStore& store, Catalogue& catalogue,
                  std::chrono::milliseconds staleness = std::chrono::milliseconds(100),
                  std::uint64_t max_bytes = UINT64_MAX)
      : store_(store), catalogue_(catalogue), staleness_(staleness), max_bytes_(max_bytes) {}

  void set_capacity(std::uint64_t max_bytes);
  std::uint64_t bytes();  // memory that the cache uses, in bytes

  // Sets the function that runs checks of the catalogue for changes in the background. Without it,
  // cached() or cached_chunk() returns null from time to time, so that the caller uses find(),
  // which checks. Call this before the first request.
  using Post = std::function<void(std::function<void()> task)>;
  void refresh_by(Post post) { post_ = std::move(post); }

  // Sets the function that returns how many more bytes the disk can hold. If opening a model copies
  // its file to the disk, models that nobody else holds are then dropped until the copy fits, the
  // least recently used first. If dropping them cannot make enough room, opening fails with kIo and
  // drops none. Call this before the first request.
  using Room = std::function<std::uint64_t()>;
  void limit_copies_to(Room room) { room_ = std::move(room); }

  // Returns the public part of a model, or null if the model does not exist or is a draft.
  Expected<std::shared_ptr<const PublishedModel>> find(const ModelId& id);

  // Returns the whole model, even if it is a draft, or null if the model does not exist. Only for
  // callers with a token.
  Expected<std::shared_ptr<const PublishedModel>> find_whole(const ModelId& id);

  // Returns the file that find() must open first, or find_whole() if `has_token` is true. Returns
  // nullopt if the model is open. Also returns nullopt if opening it would be useless: the file is
  // known to be damaged, or the cache cannot hold the model. Reads the catalogue if the model is
  // not open.
  std::optional<Sha256> unopened(const ModelId& id, bool has_token);

  // Returns the file from which find() serves the model, or find_whole() if `has_token` is true.
  // Returns nullopt if that function would return null. Reads the catalogue, but opens no file.
  // Fails if the catalogue cannot be read.
  Expected<std::optional<Sha256>> file_of(const ModelId& id, bool has_token);

  // Returns the geometry_hash() of a file that this process has opened before, otherwise nullopt.
  std::optional<Sha256> known_geometry(const Sha256& file);

  // Makes the next call check the catalogue. Call this after this process has changed the
  // catalogue.
  void refresh();

  // Returns the revision, at most `staleness` old. While it stays the same, find() and find_whole()
  // return the same models. Fails as find() does.
  Expected<ModelsRevision> revision();

  // Keeps the JSON of the model's manifest as long as the model is cached, if the memory suffices.
  void keep_manifest(const std::shared_ptr<const PublishedModel>& model,
                     std::shared_ptr<const Document> document);

  // The functions cached…() return the model or the chunk if it is cached and known to be current,
  // else null. They wait neither for the catalogue nor for the disk.
  std::shared_ptr<const PublishedModel> cached(const ModelId& id);
  std::shared_ptr<const PublishedModel> cached_whole(const ModelId& id);
  std::optional<PublishedChunk> cached_chunk(const Sha256& sha256);

  // Returns the block with this SHA-256 (file_blocks.h), if any published model has it. If the file
  // of one model is damaged, returns the block of another model.
  Expected<PublishedChunk> find_chunk(const Sha256& sha256);

  // Returns the model in which find_chunk() looks for the block: one whose file is not known to be
  // damaged, if there is one. Returns nullopt if no published model has the block. Reads the
  // catalogue, but opens no file.
  Expected<std::optional<ModelId>> model_with(const Sha256& chunk);

  // Reports that a stored file is damaged or missing. Models are not served from this file until
  // set_intact() is called, or until the file opens without a fault after a change of the
  // catalogue.
  void set_damaged(const Sha256& file);
  void set_intact(const Sha256& file);
  // Reports that a local copy of an intact file is damaged. The next request opens the file again.
  void drop_copies(const Sha256& file);
  // How often the file was reported damaged. A model with fewer damages() is outdated.
  std::uint64_t damages_of(const Sha256& file);
  // Returns the cached models that have this file open. Each may have a local copy of its own.
  std::vector<std::shared_ptr<const PublishedModel>> open_with(const Sha256& file);
  std::vector<Sha256> damaged();  // the files that are known to be damaged or missing

  // The number of requests answered from the cache, and the number of models opened.
  std::atomic<std::uint64_t> hits{0}, misses{0};

 private:
  struct HashOfHash {
    std::size_t operator()(const Sha256& sha256) const noexcept;
  };
  // The part of a model that a caller may see: the public part, or all of it.
  struct Scope {
    ModelId id;
    bool is_whole = false;
    bool operator==(const Scope&) const = default;
  };
  struct HashOfScope {
    std::size_t operator()(const Scope& scope) const noexcept;
  };
  using Clock = std::chrono::steady_clock;
  using ModelPointer = std::shared_ptr<const PublishedModel>;
  struct CachedModel {
    ModelPointer model;
    std::uint64_t bytes = 0;
    long pointers = 1;  // the cache's own pointers to the model: this one, and those in chunks_
  };
  using CachedModels = std::unordered_map<Scope, CachedModel, HashOfScope>;
  // Identifies what a record contained when it was read.
  struct RecordVersion {
    static RecordVersion of(const ModelRecord& record) {
      return {record.id, record.version, record.notes};
    }
    bool operator==(const RecordVersion&) const = default;
    ModelId id;
    std::uint64_t version = 0, notes = 0;
  };
  // An attempt to open a model, which is running or has failed. The attempt is outdated for a
  // caller that knows of a later revision of the catalogue or of a later refresh().
  struct Opening {
    std::uint64_t revision, refreshed;
    std::optional<Clock::time_point> failed = {};  // set once it has failed
    std::promise<Expected<ModelPointer>> promise = {};
    std::shared_future<Expected<ModelPointer>> result = promise.get_future().share();
  };

  bool is_fresh(Clock::time_point now, Clock::duration age) const;  // the caller holds mutex_
  bool may_show(Clock::time_point now);                             // the caller holds mutex_
  // Whether a new attempt is needed: `opening` is outdated, or it failed at least `staleness_` ago.
  // The caller holds mutex_.
  bool is_outdated(const Opening& opening, Clock::time_point now) const;
  void count_hit(const PublishedModel& model, Clock::time_point now);
  bool may_use_cache(Clock::time_point now) const;  // the caller holds mutex_
  Expected<void> forget_if_changed();
  Expected<void> ask_for_changes(Clock::time_point now);
  Expected<std::vector<RecordVersion>> unchanged(const std::vector<RecordVersion>& known);
  ModelPointer cached(const Scope& scope);
  Expected<ModelPointer> find(const Scope& scope);
  Expected<ModelPointer> load(const Scope& scope);
  Expected<ModelPointer> open(const Scope& scope);
  Expected<ModelPointer> open_newest(const Scope& scope, std::uint64_t revision);
  Expected<ModelPointer> open_file(ModelRecord record, std::uint64_t revision);
  Expected<void> reserve_copy(const ModelRecord& record);
  void learn_geometry(const PublishedModel& model);
  void set_damaged(const Sha256& file, std::uint64_t revision);  // the caller holds mutex_
  // Whether the file was found damaged at this revision of the catalogue. The caller holds mutex_.
  bool is_known_damaged(const Sha256& file, std::uint64_t revision) const;
  std::uint64_t count_of_damages(const Sha256& file) const;  // the caller holds mutex_
  void withdraw(const Sha256& file);                         // the caller holds mutex_
  void remember(const Scope& scope, const ModelPointer& model, std::uint64_t revision);
  bool try_to_remember(const Scope& scope, const ModelPointer& model, std::uint64_t revision);
  void index_chunks(CachedModel& held);                       // the caller holds mutex_
  CachedModels::iterator drop(CachedModels::iterator model);  // the caller holds mutex_
  void drop_least_recently_used();                            // the caller holds mutex_
  void make_room();                                           // the caller holds mutex_

  const ObjectStore& store_;
  Catalogue& catalogue_;
  const std::chrono::milliseconds staleness_;
  Post post_;
  Room room_;
  // Total size of the files that are being copied to the disk. Increases only while mutex_ is held.
  std::atomic<std::uint64_t> copying_{0};

  std::shared_mutex mutex_;  // guards the members below
  std::uint64_t revision_ = 0;
  Clock::time_point checked_{};
  Clock::time_point known_{};  // time of the catalogue's last response; {}: none since refresh()
  std::atomic<Clock::rep> due_{0};     // time of the next check for changes
  std::atomic<Clock::rep> asking_{0};  // start of the running check; 0: none
  // Number of refresh() calls. Data that was read before the latest call is outdated.
  std::uint64_t refreshed_ = 0;
  std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;
  CachedModels models_;
  // Blocks of the cached public parts. A block that several models have occurs several times.
  std::unordered_multimap<Sha256, PublishedChunk, HashOfHash> chunks_;
  std::unordered_map<Scope, std::shared_ptr<Opening>, HashOfScope> openings_;
  // Files that are damaged or missing, each with the revision of the catalogue at which the fault
  // was last found. While the revision stays the same, requests do not read the file again.
  std::map<Sha256, std::uint64_t> damaged_;
  std::unordered_map<Scope, std::optional<Sha256>, HashOfScope> files_;  // file_of() at revision_
  std::unordered_map<Sha256, Sha256, HashOfHash> geometries_;  // geometry_hash() of opened files
  std::set<Sha256> too_large_;  // files of models that need more than max_bytes_
  // For each file: how often the intact file or a local copy of it was found damaged. damages_ is
  // the sum.
  std::map<Sha256, std::uint64_t> damages_of_;
  std::uint64_t damages_ = 0;
};

}  // namespace vitrine::server
