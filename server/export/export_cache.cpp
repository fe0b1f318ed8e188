// SPDX-License-Identifier: Apache-2.0
#include "server/export/export_cache.h"

#include "codec/core/sha256.h"

namespace vitrine::server {

std::uint64_t ExportCache::bytes() {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

void ExportCache::set_capacity(std::uint64_t max_bytes) {
  const std::scoped_lock lock(mutex_);
  max_bytes_ = max_bytes;
  while (bytes_ > max_bytes_)
    drop_oldest();
}

bool ExportCache::keeps_files() {
  const std::scoped_lock lock(mutex_);
  return max_bytes_ > 0;
}

ExportCache::File ExportCache::find(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  return find_held(key);
}

// Returns the file under `key`, or null if there is none. The caller must hold the lock.
ExportCache::File ExportCache::find_held(const std::string& key) {
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) {
    const auto large = large_.find(key);
    return large == large_.end() ? nullptr : large->second.lock();
  }
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->file;
}

void ExportCache::insert(const std::string& key, File file) {
  const std::scoped_lock lock(mutex_);
  if (by_key_.contains(key)) return;
  if (file->bytes.size() > max_bytes_) {
    std::erase_if(large_, [](const auto& entry) { return entry.second.expired(); });
    large_[key] = file;
    return;
  }
  bytes_ += file->bytes.size();
  entries_.push_front({key, std::move(file)});
  by_key_[key] = entries_.begin();
  while (bytes_ > max_bytes_)
    drop_oldest();
}

std::optional<ExportCache::Result> ExportCache::find_or_announce(
    const std::string& key, std::promise<Expected<File>>& result) {
  const std::scoped_lock lock(mutex_);
  if (const auto begun = in_the_making_.find(key); begun != in_the_making_.end())
    return begun->second;
  File file = find_held(key);
  Result future = result.get_future().share();
  if (!file) {
    in_the_making_.emplace(key, std::move(future));
    return std::nullopt;
  }
  result.set_value(std::move(file));
  return future;
}

Expected<ExportCache::File> ExportCache::finish(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  return in_the_making_.extract(key).mapped().get();
}

Expected<ExportCache::File> ExportCache::keep(const std::string& key,
                                              Expected<std::vector<std::uint8_t>> bytes) {
  if (!bytes) return tl::unexpected(bytes.error());
  std::string etag = '"' + to_hex(sha256(*bytes)) + '"';
  auto file =
      std::make_shared<const ExportedFile>(ExportedFile{std::move(*bytes), std::move(etag)});
  insert(key, file);
  return file;
}

void ExportCache::drop_oldest() {
  bytes_ -= entries_.back().file->bytes.size();
  by_key_.erase(entries_.back().key);
  entries_.pop_back();
}

}  // namespace vitrine::server
