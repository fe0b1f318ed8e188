// SPDX-License-Identifier: Apache-2.0
#include "server/store/published_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <mutex>

#include "server/store/change.h"

namespace vitrine {
namespace {

constexpr std::size_t kMaxOpenModels = 256;  // each holds a descriptor

Unexpected damaged(const ModelRecord& record, std::string_view why) {
  return fail(ErrorCode::kState, fmt::format("model {} cannot be served: {}; publish it again",
                                             record.id.to_string(), why));
}

Expected<Manifest> read_manifest(const Object& file, const ModelRecord& record) {
  const auto head = file.read(0, std::min(record.head_bytes, file.size()));
  if (!head) return tl::unexpected(head.error());
  auto manifest = parse_header(*head);
  if (!manifest) return damaged(record, manifest.error().message);
  if (manifest->file_bytes != file.size() || manifest->head_bytes() != record.head_bytes) {
    return damaged(record, "its file has another length than its header says");
  }
  return manifest;
}

template <class Value>
std::size_t first_word(const Value& value) {
  std::size_t word;
  std::memcpy(&word, value.data(), sizeof word);
  return word;
}

}  // namespace

Expected<std::shared_ptr<const PublishedModel>> PublishedModel::open(const ObjectStore& store,
                                                                     ModelRecord record) {
  auto file = store.open(record.file);
  if (!file) return tl::unexpected(file.error());
  if (!*file) return damaged(record, "its file is missing from the store");
  auto manifest = read_manifest(**file, record);
  if (!manifest) return tl::unexpected(manifest.error());
  std::shared_ptr<PublishedModel> model(new PublishedModel);
  model->record_ = std::move(record);
  model->manifest_ = std::move(*manifest);
  model->file_ = std::move(*file);
  return model;
}

std::optional<ByteRange> PublishedModel::find(const Sha256& sha256) const {
  if (manifest_.base_sha256 == sha256) return base();
  const auto found = std::ranges::find(manifest_.chunks, sha256, &ChunkInfo::sha256);
  if (found == manifest_.chunks.end()) return std::nullopt;
  return ByteRange{found->offset, found->length};
}

std::size_t PublishedModels::HashOfHash::operator()(const Sha256& sha256) const noexcept {
  return first_word(sha256);
}

std::size_t PublishedModels::HashOfId::operator()(const ModelId& id) const noexcept {
  std::array<std::uint8_t, 8> random;  // the last bytes; the first are the time
  std::copy(id.bytes().begin() + 8, id.bytes().end(), random.begin());
  return first_word(random);
}

bool PublishedModels::is_fresh(Clock::time_point now, Clock::duration age) const {
  return checked_ != Clock::time_point{} && now - checked_ < age;
}

// One caller in each half of the staleness is sent to the catalogue, so that the many others never
// have to go there all at once.
bool PublishedModels::may_show(Clock::time_point now) {
  if (!is_fresh(now, staleness_)) return false;
  auto due = due_.load(std::memory_order_relaxed);
  const auto next = (now + staleness_ / 2).time_since_epoch().count();
  return now.time_since_epoch().count() < due || !due_.compare_exchange_strong(due, next);
}

Expected<void> PublishedModels::forget_if_changed() {
  const auto now = Clock::now();
  std::uint64_t refreshed = 0;
  {
    const std::shared_lock lock(mutex_);
    if (is_fresh(now, staleness_ / 2)) return {};
    refreshed = refreshed_;
  }
  const auto revision = catalogue_.revision();
  if (!revision) return tl::unexpected(revision.error());
  const std::unique_lock lock(mutex_);
  if (refreshed == refreshed_) {
    checked_ = now;
    due_ = (now + staleness_ / 2).time_since_epoch().count();
  }
  if (*revision == revision_) return {};
  revision_ = *revision;
  models_.clear();
  chunks_.clear();
  return {};
}

Expected<std::shared_ptr<const PublishedModel>> PublishedModels::load(const ModelId& id) {
  const auto before = catalogue_.revision();
  if (!before) return tl::unexpected(before.error());
  auto record = catalogue_.find(id);
  if (!record) return tl::unexpected(record.error());
  if (!*record || (*record)->state != ModelState::kPublished) return nullptr;
  auto model = PublishedModel::open(store_, public_view(std::move(**record)));
  if (!model) return model;
  remember(*model, *before);
  return model;
}

void PublishedModels::remember(const std::shared_ptr<const PublishedModel>& model,
                               std::uint64_t revision) {
  const std::unique_lock lock(mutex_);
  if (revision != revision_) return;  // what was read may be old by now
  if (models_.size() >= kMaxOpenModels) {
    models_.clear();
    chunks_.clear();
  }
  const Manifest& manifest = model->manifest();
  models_[model->record().id] = model;
  chunks_[manifest.base_sha256] = {model, model->base()};
  for (std::size_t i = 0; i < manifest.chunks.size(); ++i) {
    chunks_[manifest.chunks[i].sha256] = {model, model->chunk(i)};
  }
}

Expected<std::shared_ptr<const PublishedModel>> PublishedModels::find(const ModelId& id) {
  if (auto fresh = forget_if_changed(); !fresh) return tl::unexpected(fresh.error());
  {
    const std::shared_lock lock(mutex_);
    if (const auto it = models_.find(id); it != models_.end()) return it->second;
  }
  return load(id);
}

Expected<std::shared_ptr<const PublishedModel>> PublishedModels::open_whole(const ModelId& id) {
  auto record = catalogue_.find(id);
  if (!record) return tl::unexpected(record.error());
  if (!*record) return nullptr;
  return PublishedModel::open(store_, std::move(**record));
}

void PublishedModels::refresh() {
  const std::unique_lock lock(mutex_);
  ++refreshed_;
  checked_ = {};
}

std::shared_ptr<const PublishedModel> PublishedModels::held(const ModelId& id) {
  const std::shared_lock lock(mutex_);
  if (!may_show(Clock::now())) return nullptr;
  const auto it = models_.find(id);
  return it == models_.end() ? nullptr : it->second;
}

std::optional<PublishedChunk> PublishedModels::held_chunk(const Sha256& sha256) {
  const std::shared_lock lock(mutex_);
  if (!may_show(Clock::now())) return std::nullopt;
  const auto it = chunks_.find(sha256);
  return it == chunks_.end() ? std::nullopt : std::optional(it->second);
}

Expected<PublishedChunk> PublishedModels::find_chunk(const Sha256& sha256) {
  if (auto fresh = forget_if_changed(); !fresh) return tl::unexpected(fresh.error());
  {
    const std::shared_lock lock(mutex_);
    if (const auto it = chunks_.find(sha256); it != chunks_.end()) return it->second;
  }
  const auto location = catalogue_.find_chunk(sha256);
  if (!location) return tl::unexpected(location.error());
  if (!*location) return PublishedChunk{};
  const auto model = load((*location)->model);
  if (!model) return tl::unexpected(model.error());
  // The model may have got another file since: only its own manifest says what lies where.
  const auto range = *model ? (*model)->find(sha256) : std::nullopt;
  return range ? PublishedChunk{*model, *range} : PublishedChunk{};
}

}  // namespace vitrine
