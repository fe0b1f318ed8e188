// SPDX-License-Identifier: Apache-2.0
// Remembers which object files of a store have been checked, so that each file is hashed only once.
#pragma once

#include <sys/stat.h>

#include <map>
#include <mutex>

#include "codec/core/sha256.h"

namespace vitrine::server {

// The identity and the last change of a file. If a file is replaced or written, its stamp changes.
struct FileStamp {
  dev_t device = 0;
  ino_t inode = 0;
  off_t size = 0;
  timespec modified{}, changed{};

  static FileStamp of(const struct stat& status) {
    return {status.st_dev, status.st_ino, status.st_size, status.st_mtim, status.st_ctim};
  }
  bool operator==(const FileStamp& other) const {
    const auto is_same = [](const timespec& a, const timespec& b) {
      return a.tv_sec == b.tv_sec && a.tv_nsec == b.tv_nsec;
    };
    return device == other.device && inode == other.inode && size == other.size &&
           is_same(modified, other.modified) && is_same(changed, other.changed);
  }
};

// Thread-safe. Remembers at most kMost files, which takes about 10 MB. When this limit is reached,
// forgets all files; the store then hashes each file again when it opens the file.
class CheckedObjects {
 public:
  static constexpr std::size_t kMost = 1 << 16;

  bool contains(const Sha256& name, const FileStamp& stamp) {
    const std::scoped_lock lock(mutex_);
    const auto found = checked_.find(name);
    return found != checked_.end() && found->second == stamp;
  }
  void add(const Sha256& name, const FileStamp& stamp) {
    const std::scoped_lock lock(mutex_);
    if (checked_.size() >= kMost) checked_.clear();
    checked_.insert_or_assign(name, stamp);
  }
  void forget(const Sha256& name) {
    const std::scoped_lock lock(mutex_);
    checked_.erase(name);
  }

 private:
  std::mutex mutex_;
  std::map<Sha256, FileStamp> checked_;
};

}  // namespace vitrine::server
