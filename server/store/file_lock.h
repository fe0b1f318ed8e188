// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <filesystem>
#include <memory>

#include "codec/files/file_descriptor.h"

namespace vitrine {

// Waits until nobody else, in any process, holds the lock of the open file, and takes it; it goes
// with the descriptor. False where the file system refuses; errno says why.
inline bool lock_file(int fd) {
  while (::flock(fd, LOCK_EX) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

// The same of a folder, until the last copy of the result is gone. Null where the file system
// refuses; errno says why.
inline std::shared_ptr<const void> lock_folder(const std::filesystem::path& folder) {
  auto held =
      std::make_shared<FileDescriptor>(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!*held || !lock_file(held->get())) return nullptr;
  return held;
}

}  // namespace vitrine
