// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <utility>

#include "codec/files/file_descriptor.h"
#include "server/catalogue/exclusive_lock.h"

namespace vitrine {

// Waits until nobody else, in any process, holds the lock of the open file, and takes it; it goes
// with the descriptor. False where the file system refuses; errno says why.
inline bool lock_file(int fd) {
  while (::flock(fd, LOCK_EX) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

// Of a file system: it is held as long as it exists.
class FolderLock final : public ExclusiveLock {
 public:
  explicit FolderLock(FileDescriptor folder) : folder_(std::move(folder)) {}
  Expected<void> check() const override { return {}; }

 private:
  const FileDescriptor folder_;
};

// The same of a folder, until the last copy of the result is gone. Null where the file system
// refuses; errno says why.
inline std::shared_ptr<const ExclusiveLock> lock_folder(const std::filesystem::path& folder) {
  FileDescriptor held(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!held || !lock_file(held.get())) return nullptr;
  return std::make_shared<FolderLock>(std::move(held));
}

}  // namespace vitrine
