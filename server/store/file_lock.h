// SPDX-License-Identifier: Apache-2.0
// Locks open files and folders.
#pragma once

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <utility>

#include "codec/files/file_descriptor.h"
#include "server/catalogue/exclusive_lock.h"

namespace vitrine::server {

// Waits for the lock on an open file and acquires it. The lock is released when the descriptor is
// closed. The lock excludes other processes and other descriptors of this process. Returns false
// and sets errno if the file system refuses.
inline bool lock_file(int fd) {
  while (::flock(fd, LOCK_EX) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

// A lock on a folder, held until the object is destroyed.
class FolderLock final : public ExclusiveLock {
 public:
  explicit FolderLock(FileDescriptor folder) : folder_(std::move(folder)) {}
  Expected<void> check() const override { return {}; }

 private:
  const FileDescriptor folder_;
};

// Waits for the lock on a folder and acquires it. The lock is released when the last copy of the
// result is destroyed. Returns null and sets errno if the file system refuses.
inline std::shared_ptr<const ExclusiveLock> lock_folder(const std::filesystem::path& folder) {
  FileDescriptor held(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!held || !lock_file(held.get())) return nullptr;
  return std::make_shared<FolderLock>(std::move(held));
}

}  // namespace vitrine::server
