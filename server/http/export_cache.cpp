// SPDX-License-Identifier: Apache-2.0
#include "server/http/export_cache.h"

#include "codec/core/sha256.h"

namespace vitrine {

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

ExportCache::File ExportCache::find(const std::string& key) {
  const std::scoped_lock lock(mutex_);
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

ExportCache::File ExportCache::keep(const std::string& key, std::vector<std::uint8_t> bytes) {
  std::string etag = '"' + to_hex(sha256(bytes)) + '"';
  auto file = std::make_shared<const ExportedFile>(ExportedFile{std::move(bytes), std::move(etag)});
  insert(key, file);
  return file;
}

void ExportCache::drop_oldest() {
  bytes_ -= entries_.back().file->bytes.size();
  by_key_.erase(entries_.back().key);
  entries_.pop_back();
}

}  // namespace vitrine
