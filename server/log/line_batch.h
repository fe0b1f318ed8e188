// SPDX-License-Identifier: Apache-2.0
// Collects lines in a batch, so that one write(2) writes all lines added since the previous write.
#pragma once

#include <mutex>
#include <string>
#include <string_view>

namespace vitrine::server {

// Thread-safe.
class LineBatch {
 public:
  // Adds a line. Returns true if the line is the first of a batch; the caller must then call
  // flush() soon. A batch that has grown large is written at once.
  bool add(std::string_view line, int descriptor);
  void flush(int descriptor);

 private:
  void write(int descriptor);  // the caller must hold the lock

  std::mutex mutex_;  // guards the members below
  std::string lines_;
};

}  // namespace vitrine::server
