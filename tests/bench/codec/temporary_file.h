// SPDX-License-Identifier: Apache-2.0
// Files with given bytes for programs that are measured, removed after use.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "peers.h"
#include "support/product_names.h"

namespace vitrine::bench {

// A file that the destructor removes.
class TemporaryFile {
 public:
  explicit TemporaryFile(const Bytes& bytes, const std::string& extension = {})
      : path_("/tmp/bench-codec-XXXXXX" + extension) {
    const int fd = ::mkstemps(path_.data(), static_cast<int>(extension.size()));
    if (fd < 0 || ::write(fd, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("cannot write a temporary file");
    ::close(fd);
  }
  ~TemporaryFile() { ::unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const char* path() const { return path_.c_str(); }

 private:
  std::string path_;
};

}  // namespace vitrine::bench
