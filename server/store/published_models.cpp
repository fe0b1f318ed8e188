// SPDX-License-Identifier: Apache-2.0
// Implements the cache of models, PublishedModels.
#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <mutex>
#include <span>

#include "codec/format/file_blocks.h"
#include "server/store/change.h"
#include "server/store/published_model.h"

namespace vitrine::server {
namespace {

constexpr std::size_t kMaxOpenModels = 256;  // limit on cached models; each keeps a file open
// At most this many models that share a chunk are tried until one has an intact file.
constexpr int kMostOwners = 8;
// How long cached models are served while the catalogue is unreachable.
constexpr std::chrono::minutes kUnreachableFor{15};
// If the catalogue takes longer to respond, it counts as unreachable.
constexpr std::chrono::milliseconds kResponseTime{250};

// Returns the memory, in bytes, for the manifest and the index of its chunks.
std::uint64_t memory_of(const Manifest& manifest) {
  constexpr std::uint64_t kEntry =
      sizeof(Sha256) + sizeof(PublishedChunk) + 4 * sizeof(void*) + sizeof(std::uint32_t);
  const std::size_t pictures = manifest.texture.pictures.size();
  const std::size_t optional = manifest.optional_blocks.size();
  std::uint64_t bytes =
      sizeof(PublishedModel) + (manifest.chunks.size() + pictures + optional + 2) * kEntry +
      pictures * sizeof(PictureInfo) + optional * sizeof(OptionalBlock) +
      manifest.chunks.size() * sizeof(ChunkInfo) + manifest.levels.size() * sizeof(LevelInfo) +
      manifest.tree.nodes.size() * sizeof(RegionNode);
  using Leaves = decltype(manifest.adjacency)::value_type;
  for (const Leaves& leaves : manifest.adjacency)
    bytes += sizeof(Leaves) + leaves.size() * sizeof(Leaves::value_type);
  return bytes;
}

template <class Value>
std::size_t first_word(const Value& value) {
  std::size_t word;
  std::memcpy(&word, value.data(), sizeof word);
  return word;
}

// Returns the whole record if `is_whole`, otherwise its public view. Returns nullopt if the public
// view of a draft is requested.
std::optional<ModelRecord> shown(ModelRecord record, bool is_whole) {
  if (is_whole) return record;
  if (record.state != ModelState::kPublished) return std::nullopt;
  return public_view(std::move(record));
}

}  // namespace

std::size_t PublishedModels::HashOfHash::operator()(const Sha256& sha256) const noexcept {
  return first_word(sha256);
}

std::size_t PublishedModels::HashOfScope::operator()(const Scope& scope) const noexcept {
  // The first bytes of an ID encode the time of its creation; the last eight are random.
  return first_word(std::span(scope.id.bytes()).last<8>()) + (scope.is_whole ? 1 : 0);
}

bool PublishedModels::is_fresh(Clock::time_point now, Clock::duration age) const {
  return checked_ != Clock::time_point{} && now - checked_ < age;
}

// Whether a caller may use the cache without first checking the catalogue for changes. When half of
// staleness_ has passed since the last check, starts the next check in the background. If no
// function was set by refresh_by(), returns false to one caller instead. That caller makes the
// check, and all other callers use the cache meanwhile.
bool PublishedModels::may_show(Clock::time_point now) {
  if (!is_fresh(now, staleness_)) return false;
  auto due = due_.load(std::memory_order_relaxed);
  const auto next = (now + staleness_ / 2).time_since_epoch().count();
  const bool is_due =
      now.time_since_epoch().count() >= due && due_.compare_exchange_strong(due, next);
  if (is_due && post_) post_([this] { static_cast<void>(forget_if_changed()); });
  return !is_due || post_;
}

void PublishedModels::count_hit(const PublishedModel& model, Clock::time_point now) {
  model.asked_.store(now.time_since_epoch().count(), std::memory_order_relaxed);
  hits.fetch_add(1, std::memory_order_relaxed);
}

bool PublishedModels::may_use_cache(Clock::time_point now) const {
  return known_ != Clock::time_point{} && now - known_ < kUnreachableFor;
}

// Drops changed models from the cache. While one caller waits for an unreachable catalogue, other
// callers use the cache.
Expected<void> PublishedModels::forget_if_changed() {
  const auto now = Clock::now();
  {
    const Clock::time_point asking(Clock::duration(asking_.load()));
    const std::shared_lock lock(mutex_);
    if (asking != Clock::time_point{} && now - asking > kResponseTime && may_use_cache(now))
      return {};
  }
  Clock::rep nobody = 0;
  const bool is_first = asking_.compare_exchange_strong(nobody, now.time_since_epoch().count());
  auto asked = ask_for_changes(now);
  if (is_first) asking_ = 0;
  if (asked) return asked;
  const std::unique_lock lock(mutex_);
  if (!may_use_cache(now)) return asked;
  checked_ = Clock::now();
  due_ = (checked_ + staleness_ / 2).time_since_epoch().count();
  return {};
}

Expected<void> PublishedModels::ask_for_changes(Clock::time_point now) {
  std::uint64_t refreshed = 0, before = 0;
  // Not pointers to the models, because reserve_copy() takes models with further pointers for used.
  std::vector<RecordVersion> held;
  {
    const std::shared_lock lock(mutex_);
    if (is_fresh(now, staleness_ / 2)) return {};
    refreshed = refreshed_;
    before = revision_;
  }
  const auto revision = catalogue_.revision();
  if (!revision) return tl::unexpected(revision.error());
  if (*revision != before) {
    const std::shared_lock lock(mutex_);
    for (const auto& [scope, entry] : models_)
      held.push_back(RecordVersion::of(entry.model->record()));
  }
  const auto kept = unchanged(held);
  if (!kept) return tl::unexpected(kept.error());
  const std::unique_lock lock(mutex_);
  if (refreshed == refreshed_) {
    checked_ = known_ = now;
    due_ = (now + staleness_ / 2).time_since_epoch().count();
  }
  if (*revision == revision_) return {};
  revision_ = *revision;
  files_.clear();
  // Also drops a model that was opened during the check, if its version was not checked.
  for (auto it = models_.begin(); it != models_.end();) {
    const auto version = RecordVersion::of(it->second.model->record());
    it = std::ranges::count(*kept, version) > 0 ? std::next(it) : drop(it);
  }
  return {};
}

// Returns those versions that are the current ones in the catalogue.
Expected<std::vector<PublishedModels::RecordVersion>> PublishedModels::unchanged(
    const std::vector<RecordVersion>& known) {
  std::vector<RecordVersion> kept;
  for (const RecordVersion& version : known) {
    const auto record = catalogue_.find(version.id);
    if (!record) return tl::unexpected(record.error());
    if (*record && RecordVersion::of(**record) == version) kept.push_back(version);
  }
  return kept;
}

bool PublishedModels::is_outdated(const Opening& opening, Clock::time_point now) const {
  return opening.revision != revision_ || opening.refreshed != refreshed_ ||
         (opening.failed && now - *opening.failed >= staleness_);
}

// Opens a model unless it is cached. If several callers request it at once, one caller opens it and
// the other callers wait for the result.
Expected<PublishedModels::ModelPointer> PublishedModels::load(const Scope& scope) {
  std::shared_ptr<Opening> own, other;
  {
    const std::unique_lock lock(mutex_);
    if (const auto it = models_.find(scope); it != models_.end()) return it->second.model;
    const auto now = Clock::now();
    std::erase_if(openings_, [&](const auto& entry) {
      return !entry.second || (entry.second->failed && is_outdated(*entry.second, now));
    });
    auto& opening = openings_[scope];
    if (opening && !is_outdated(*opening, now)) {
      other = opening;
    } else {
      own = opening = std::make_shared<Opening>(Opening{revision_, refreshed_});
    }
  }
  if (other) return other->result.get();
  misses.fetch_add(1, std::memory_order_relaxed);
  bool has_failed = false;
  try {
    auto model = open(scope);
    has_failed = !model && model.error().code == ErrorCode::kIo;
    own->promise.set_value(std::move(model));
  } catch (...) {  // such as std::bad_alloc: the waiting callers fail, the next one tries again
    own->promise.set_exception(std::current_exception());
  }
  const std::unique_lock lock(mutex_);
  if (has_failed) own->failed = Clock::now();
  const auto it = openings_.find(scope);
  if (!has_failed && it != openings_.end() && it->second == own) openings_.erase(it);
  return own->result.get();
}

Expected<PublishedModels::ModelPointer> PublishedModels::open(const Scope& scope) {
  const auto before = catalogue_.revision();
  if (!before) return tl::unexpected(before.error());
  auto model = open_newest(scope, *before);
  if (model && *model) remember(scope, *model, *before);
  return model;
}

// Opens the newest version of a model. `revision` is the catalogue's revision before this call.
// Returns null if the scope does not include the model. If the file is missing (kState), the model
// may have been replaced and its old file removed. Therefore looks up the record again, and fails
// only if its version is still the same.
Expected<PublishedModels::ModelPointer> PublishedModels::open_newest(const Scope& scope,
                                                                     std::uint64_t revision) {
  for (std::optional<std::uint64_t> failed;;) {
    auto record = catalogue_.find(scope.id);
    if (!record) return tl::unexpected(record.error());
    auto seen = *record ? shown(std::move(**record), scope.is_whole) : std::nullopt;
    if (!seen) return nullptr;
    const std::uint64_t version = seen->version;
    const Sha256 file = seen->file;
    auto model = open_file(std::move(*seen), revision);
    if (model || model.error().code != ErrorCode::kState) return model;
    if (failed == version) {
      const std::unique_lock lock(mutex_);
      set_damaged(file, revision);
      return model;
    }
    failed = version;
  }
}

// Opens the file of `record`. Fails if the file is known to be damaged at `revision`, the
// catalogue's current revision. The cache's revision_ may be older, and the file may have been
// repaired since then.
Expected<PublishedModels::ModelPointer> PublishedModels::open_file(ModelRecord record,
                                                                   std::uint64_t revision) {
  const Sha256 file = record.file;
  bool was_damaged = false;  // whether the file was damaged at an earlier revision
  std::uint64_t damages = 0;
  {
    const std::shared_lock lock(mutex_);
    if (is_known_damaged(file, revision))
      return PublishedModel::damaged(record, "its file " + to_hex(file) + " is damaged or missing");
    was_damaged = damaged_.contains(file);
    damages = count_of_damages(file);
  }
  struct Copying {
    ~Copying() { sum -= bytes; }
    std::atomic<std::uint64_t>& sum;
    std::uint64_t bytes = 0;
  } copying{copying_};
  if (room_ && store_.keeps_copies()) {
    if (auto reserved = reserve_copy(record); !reserved) return tl::unexpected(reserved.error());
    copying.bytes = record.file_bytes;
  }
  auto model = PublishedModel::open(store_, std::move(record), damages);
  if (model && was_damaged) set_intact(file);
  if (model) learn_geometry(**model);
  return model;
}

void PublishedModels::learn_geometry(const PublishedModel& model) {
  const Sha256& file = model.record().file;
  if (known_geometry(file)) return;
  const Sha256 geometry = geometry_hash(model.manifest());
  const std::unique_lock lock(mutex_);
  geometries_.emplace(file, geometry);
}

std::optional<Sha256> PublishedModels::known_geometry(const Sha256& file) {
  const std::shared_lock lock(mutex_);
  const auto found = geometries_.find(file);
  return found == geometries_.end() ? std::nullopt : std::optional(found->second);
}

// Adds the file to `copying_`. If the disk lacks room for the copy, drops models that nobody else
// holds; if together they would free too little, keeps them and fails. A model being sent would
// free its room only later, so it stays. Copies in progress count in full, because it is unknown
// how much of them is on the disk. File systems report freed room only after seconds, so it is
// added up.
Expected<void> PublishedModels::reserve_copy(const ModelRecord& record) {
  const std::unique_lock lock(mutex_);
  const std::uint64_t needed = copying_ + record.file_bytes, room = room_();
  const std::uint64_t lacking = needed - std::min(needed, room);
  std::uint64_t droppable = 0, freed = 0;
  std::vector<CachedModels::iterator> unused;
  for (auto it = models_.begin(); lacking > 0 && it != models_.end(); ++it) {
    if (it->second.model.use_count() > it->second.pointers) continue;
    unused.push_back(it);
    droppable += it->second.model->file().size();
  }
  if (lacking > droppable) {
    return fail(ErrorCode::kIo,
                fmt::format("model {} cannot be opened: copies of objects need {} bytes, but the "
                            "disk of the data folder has room for {} beside disk-reserve; free "
                            "some space, or lower disk-reserve",
                            record.id.to_string(), needed, room));
  }
  std::ranges::sort(unused, {}, [](auto held) { return held->second.model->asked_.load(); });
  for (auto next = unused.begin(); freed < lacking; drop(*next++))
    freed += (*next)->second.model->file().size();
  copying_ += record.file_bytes;
  return {};
}

bool PublishedModels::is_known_damaged(const Sha256& file, std::uint64_t revision) const {
  const auto found = damaged_.find(file);
  return found != damaged_.end() && found->second == revision;
}

void PublishedModels::set_damaged(const Sha256& file) {
  const std::unique_lock lock(mutex_);
  set_damaged(file, revision_);
}

void PublishedModels::set_damaged(const Sha256& file, std::uint64_t revision) {
  const bool is_new = damaged_.insert_or_assign(file, revision).second;
  if (is_new) ++damages_of_[file], ++damages_;
  withdraw(file);
}

void PublishedModels::drop_copies(const Sha256& file) {
  const std::unique_lock lock(mutex_);
  ++damages_of_[file], ++damages_;
  withdraw(file);
}

std::uint64_t PublishedModels::damages_of(const Sha256& file) {
  const std::shared_lock lock(mutex_);
  return count_of_damages(file);
}

std::uint64_t PublishedModels::count_of_damages(const Sha256& file) const {
  const auto found = damages_of_.find(file);
  return found == damages_of_.end() ? 0 : found->second;
}

void PublishedModels::withdraw(const Sha256& file) {
  for (auto it = models_.begin(); it != models_.end();)
    it = it->second.model->record().file == file ? drop(it) : std::next(it);
}

void PublishedModels::set_intact(const Sha256& file) {
  const std::unique_lock lock(mutex_);
  damaged_.erase(file);
}

std::vector<PublishedModels::ModelPointer> PublishedModels::open_with(const Sha256& file) {
  const std::shared_lock lock(mutex_);
  std::vector<ModelPointer> open;
  for (const auto& [scope, entry] : models_)
    if (entry.model->record().file == file) open.push_back(entry.model);
  return open;
}

std::vector<Sha256> PublishedModels::damaged() {
  const std::shared_lock lock(mutex_);
  std::vector<Sha256> files;
  for (const auto& [file, revision] : damaged_)
    files.push_back(file);
  return files;
}

// Caches the model. Opening a model may take long. If the catalogue has changed meanwhile, caches
// the model only if its version is still the same.
void PublishedModels::remember(const Scope& scope, const ModelPointer& model,
                               std::uint64_t revision) {
  while (!try_to_remember(scope, model, revision)) {
    {
      const std::shared_lock lock(mutex_);
      revision = revision_;
    }
    const auto kept = unchanged({RecordVersion::of(model->record())});
    if (!kept || kept->empty()) return;
  }
}

// Returns false if `revision`, at which the model was current, is not the cache's revision.
bool PublishedModels::try_to_remember(const Scope& scope, const ModelPointer& model,
                                      std::uint64_t revision) {
  const std::uint64_t bytes = memory_of(model->manifest());
  const Sha256& file = model->record().file;
  const std::unique_lock lock(mutex_);
  if (revision != revision_) return false;
  // Does not cache the model if another caller has found its file damaged in the meantime.
  if (damaged_.contains(file) || count_of_damages(file) != model->damages()) return true;
  if (bytes > max_bytes_) too_large_.insert(file);
  if (bytes > max_bytes_ || models_.contains(scope)) return true;
  model->asked_ = Clock::now().time_since_epoch().count();
  CachedModel& held = models_[scope] = {model, bytes};
  bytes_ += bytes;
  if (!scope.is_whole) index_chunks(held);
  make_room();
  return true;
}

void PublishedModels::index_chunks(CachedModel& held) {
  for_each_block(held.model->manifest(), [&](const FileBlock& block) {
    chunks_.insert({block.sha256, {held.model, {block.offset, block.length}}});
    ++held.pointers;
  });
}

void PublishedModels::keep_manifest(const ModelPointer& model,
                                    std::shared_ptr<const Document> document) {
  const std::uint64_t bytes =
      sizeof *document + document->text.size() + document->etag.size() + document->gzip.size();
  const std::unique_lock lock(mutex_);
  const auto it = models_.find({model->record().id});
  const bool is_held = it != models_.end() && it->second.model == model;
  if (!is_held || model->kept_manifest() || it->second.bytes + bytes > max_bytes_) return;
  std::atomic_store(&model->told_, std::move(document));
  it->second.bytes += bytes;
  bytes_ += bytes;
  make_room();
}

PublishedModels::CachedModels::iterator PublishedModels::drop(CachedModels::iterator held) {
  const ModelPointer model = held->second.model;
  for_each_block(model->manifest(), [&](const FileBlock& block) {
    const auto [first, last] = chunks_.equal_range(block.sha256);
    const auto own =
        std::find_if(first, last, [&](const auto& at) { return at.second.model == model; });
    if (own != last) chunks_.erase(own);
  });
  bytes_ -= held->second.bytes;
  return models_.erase(held);
}

void PublishedModels::drop_least_recently_used() {
  drop(std::ranges::min_element(models_, {}, [](const auto& entry) {
    return entry.second.model->asked_.load(std::memory_order_relaxed);
  }));
}

void PublishedModels::make_room() {
  while (bytes_ > max_bytes_ || models_.size() > kMaxOpenModels)
    drop_least_recently_used();
}

void PublishedModels::set_capacity(std::uint64_t max_bytes) {
  const std::unique_lock lock(mutex_);
  max_bytes_ = max_bytes;
  too_large_.clear();
  make_room();
}

std::uint64_t PublishedModels::bytes() {
  const std::shared_lock lock(mutex_);
  return bytes_;
}

Expected<std::shared_ptr<const PublishedModel>> PublishedModels::find(const ModelId& id) {
  return find(Scope{.id = id});
}

Expected<std::shared_ptr<const PublishedModel>> PublishedModels::find_whole(const ModelId& id) {
  return find(Scope{.id = id, .is_whole = true});
}

Expected<PublishedModels::ModelPointer> PublishedModels::find(const Scope& scope) {
  if (auto fresh = forget_if_changed(); !fresh) return tl::unexpected(fresh.error());
  {
    const std::shared_lock lock(mutex_);
    if (const auto it = models_.find(scope); it != models_.end()) {
      count_hit(*it->second.model, Clock::now());
      return it->second.model;
    }
  }
  return load(scope);
}

Expected<ModelsRevision> PublishedModels::revision() {
  if (auto fresh = forget_if_changed(); !fresh) return tl::unexpected(fresh.error());
  const std::shared_lock lock(mutex_);
  return ModelsRevision{revision_, damages_};
}

std::optional<Sha256> PublishedModels::unopened(const ModelId& id, bool has_token) {
  {
    const std::shared_lock lock(mutex_);
    const auto it = models_.find(Scope{.id = id});
    const bool is_open =
        it != models_.end() && !(has_token && it->second.model->record().public_part);
    if (is_open || (has_token && models_.contains(Scope{.id = id, .is_whole = true})))
      return std::nullopt;
  }
  auto record = catalogue_.find(id);
  if (!record || !*record) return std::nullopt;
  const auto seen = shown(std::move(**record), has_token);
  if (!seen) return std::nullopt;
  const std::shared_lock lock(mutex_);
  const bool is_in_vain =
      is_known_damaged(seen->file, revision_) || max_bytes_ == 0 || too_large_.contains(seen->file);
  return is_in_vain ? std::nullopt : std::optional(seen->file);
}

// Reads the record of a model once while the revision stays the same, because many streams may show
// the model.
Expected<std::optional<Sha256>> PublishedModels::file_of(const ModelId& id, bool has_token) {
  if (auto fresh = forget_if_changed(); !fresh) return tl::unexpected(fresh.error());
  const Scope scope{.id = id, .is_whole = has_token};
  std::uint64_t revision = 0;
  {
    const std::shared_lock lock(mutex_);
    if (const auto it = models_.find(scope); it != models_.end())
      return it->second.model->record().file;
    if (const auto it = files_.find(scope); it != files_.end()) return it->second;
    revision = revision_;
  }
  auto record = catalogue_.find(id);
  if (!record) return tl::unexpected(record.error());
  const auto seen = *record ? shown(std::move(**record), has_token) : std::nullopt;
  const auto file = seen ? std::optional(seen->file) : std::nullopt;
  const std::unique_lock lock(mutex_);
  if (revision == revision_) files_[scope] = file;
  return file;
}

void PublishedModels::refresh() {
  const std::unique_lock lock(mutex_);
  ++refreshed_;
  checked_ = known_ = {};
}

std::shared_ptr<const PublishedModel> PublishedModels::cached(const ModelId& id) {
  return cached(Scope{.id = id});
}

std::shared_ptr<const PublishedModel> PublishedModels::cached_whole(const ModelId& id) {
  return cached(Scope{.id = id, .is_whole = true});
}

PublishedModels::ModelPointer PublishedModels::cached(const Scope& scope) {
  const auto now = Clock::now();
  const std::shared_lock lock(mutex_);
  if (!may_show(now)) return nullptr;
  const auto it = models_.find(scope);
  if (it == models_.end()) return nullptr;
  count_hit(*it->second.model, now);
  return it->second.model;
}

std::optional<PublishedChunk> PublishedModels::cached_chunk(const Sha256& sha256) {
  const auto now = Clock::now();
  const std::shared_lock lock(mutex_);
  if (!may_show(now)) return std::nullopt;
  const auto it = chunks_.find(sha256);
  if (it == chunks_.end()) return std::nullopt;
  count_hit(*it->second.model, now);
  return it->second;
}

Expected<std::optional<ModelId>> PublishedModels::model_with(const Sha256& chunk) {
  std::optional<ModelId> first;
  ModelId last;
  for (int i = 0; i < kMostOwners; ++i) {
    const auto location = catalogue_.find_chunk_after(chunk, last);
    if (!location) return tl::unexpected(location.error());
    if (!*location) break;
    last = (*location)->model;
    if (!first) first = last;
    const auto file = file_of(last, false);
    if (!file) return tl::unexpected(file.error());
    const std::shared_lock lock(mutex_);
    if (*file && !is_known_damaged(**file, revision_)) return last;
  }
  return first;
}

Expected<PublishedChunk> PublishedModels::find_chunk(const Sha256& sha256) {
  if (auto fresh = forget_if_changed(); !fresh) return tl::unexpected(fresh.error());
  {
    const std::shared_lock lock(mutex_);
    if (const auto it = chunks_.find(sha256); it != chunks_.end()) return it->second;
  }
  auto owner = model_with(sha256);
  if (!owner) return tl::unexpected(owner.error());
  if (!*owner) return PublishedChunk{};
  auto model = load({**owner});
  // A file was found damaged, so tries the next model.
  for (int i = 1; i < kMostOwners && !model && model.error().code == ErrorCode::kState; ++i) {
    const auto next = catalogue_.find_chunk_after(sha256, **owner);
    if (!next) return tl::unexpected(next.error());
    if (!*next) break;
    model = load({owner->emplace((*next)->model)});
  }
  if (!model) return tl::unexpected(model.error());
  // The model may have a new file by now, so the position is looked up in the manifest of that
  // file.
  const auto range = *model ? (*model)->find(sha256) : std::nullopt;
  return range ? PublishedChunk{*model, *range} : PublishedChunk{};
}

}  // namespace vitrine::server
