// SPDX-License-Identifier: Apache-2.0
// Opens the file of a log, and replaces the file when it has grown to its limit. The log therefore
// takes at most twice this limit on the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>

#include "codec/core/expected.h"

namespace vitrine::server {

// The file in which a log is written. Thread-safe.
class LogFile {
 public:
  // Makes `descriptor` refer to `file`. "-" means standard error, and an empty path means
  // /dev/null. Replaces a regular file that has reached `max_bytes`, unless `max_bytes` is 0.
  // If the file cannot be opened (kIo), `descriptor` stays unchanged.
  Expected<void> open(int descriptor, const std::filesystem::path& file, std::uint64_t max_bytes);

  // If the file has reached its limit, renames it to FILE.old, which replaces an older one, and
  // continues in a new file. If another process has already renamed the file, continues in the new
  // file. If any of this fails, the log continues in the old file.
  void replace_if_full(int descriptor);

 private:
  std::mutex mutex_;  // guards the members below
  std::filesystem::path file_;
  std::uint64_t max_bytes_ = 0;
};

}  // namespace vitrine::server
