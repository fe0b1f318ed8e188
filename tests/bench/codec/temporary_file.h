// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

#include "peers.h"

namespace vitrine::bench {

// A file that goes with the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const Bytes& bytes) {
    const int fd = ::mkstemp(path_);
    if (fd < 0 || ::write(fd, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("cannot write a temporary file");
    ::close(fd);
  }
  ~TemporaryFile() { ::unlink(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const char* path() const { return path_; }

 private:
  char path_[40] = "/tmp/bench-codec-XXXXXX";
};

}  // namespace vitrine::bench
