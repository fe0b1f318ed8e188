// SPDX-License-Identifier: Apache-2.0
#include "server/log/line_batch.h"

#include "server/log/write_whole.h"

namespace vitrine::server {

bool LineBatch::add(std::string_view line, int descriptor) {
  constexpr std::size_t kLarge = 64 * 1024;
  const std::scoped_lock lock(mutex_);
  const bool is_first = lines_.empty();
  lines_ += line;
  if (lines_.size() >= kLarge) write(descriptor);
  return is_first;
}

void LineBatch::flush(int descriptor) {
  const std::scoped_lock lock(mutex_);
  if (!lines_.empty()) write(descriptor);
}

void LineBatch::write(int descriptor) {
  write_whole(descriptor, lines_);
  lines_.clear();
}

}  // namespace vitrine::server
