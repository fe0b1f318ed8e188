// SPDX-License-Identifier: Apache-2.0
// Lines that are written together: one write(2) for all that came since the last one.
#pragma once

#include <mutex>
#include <string>
#include <string_view>

namespace vitrine {

// Thread-safe.
class LineBatch {
 public:
  // True for the first line of a batch: its caller sees to a flush() soon. A batch that grows large
  // is written at once.
  bool add(std::string_view line, int descriptor);
  void flush(int descriptor);

 private:
  void write(int descriptor);  // with the lock held

  std::mutex mutex_;  // guards what follows
  std::string lines_;
};

}  // namespace vitrine
