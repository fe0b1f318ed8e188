// SPDX-License-Identifier: Apache-2.0
#include "server/http/export_cache.h"

namespace vitrine {

ExportCache::File ExportCache::find(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->file;
}

void ExportCache::insert(const std::string& key, File file) {
  const std::scoped_lock lock(mutex_);
  if (file->bytes.size() > max_bytes_ || by_key_.contains(key)) return;
  bytes_ += file->bytes.size();
  entries_.push_front({key, std::move(file)});
  by_key_[key] = entries_.begin();
  while (bytes_ > max_bytes_)
    drop_oldest();
}

void ExportCache::drop_oldest() {
  bytes_ -= entries_.back().file->bytes.size();
  by_key_.erase(entries_.back().key);
  entries_.pop_back();
}

}  // namespace vitrine
