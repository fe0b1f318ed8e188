// SPDX-License-Identifier: Apache-2.0
// A class that owns a file descriptor, and a function that keeps the three standard streams open.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <utility>

namespace vitrine::inline codec {

class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileDescriptor() { reset(); }

  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  void reset() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_ = -1;
};

// Opens /dev/null for each standard stream that is closed. Without this, the next opened file would
// get the stream's number, and messages would be written into it. Call this first in main().
inline void keep_standard_streams() {
  int fd = 0;
  while (fd >= 0 && fd <= STDERR_FILENO)
    fd = ::open("/dev/null", O_RDWR);
  if (fd >= 0) ::close(fd);
}

}  // namespace vitrine::inline codec
