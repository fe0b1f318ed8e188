// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/file.h>

#include <cerrno>

namespace vitrine {

// Waits until nobody else, in any process, holds the lock of the open file, and takes it; it goes
// with the descriptor. False where the file system refuses; errno says why.
inline bool lock_file(int fd) {
  while (::flock(fd, LOCK_EX) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

}  // namespace vitrine
