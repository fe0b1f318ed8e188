// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/line_reader.h"

#include <utility>

namespace vitrine::acquisition {

void LineReader::feed(std::string_view bytes) {
  for (const char byte : bytes) {
    if (byte == '\r') continue;
    if (byte == '\n') {
      end_line();
      continue;
    }
    if (byte < ' ' || byte > '~' || line_.size() == kLongest)
      is_garbage_ = true;
    else
      line_ += byte;
    if (byte == prompt_ && line_.size() == 1) end_line();
  }
}

void LineReader::end_line() {
  if (is_garbage_)
    lines_.emplace_back(kGarbage);
  else if (!line_.empty())
    lines_.push_back(line_);
  if (lines_.size() > kMostLines) lines_.pop_front();
  line_.clear();
  is_garbage_ = false;
}

std::optional<std::string> LineReader::next() {
  if (lines_.empty()) return std::nullopt;
  std::string line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

void LineReader::clear() {
  line_.clear();
  lines_.clear();
  is_garbage_ = false;
}

}  // namespace vitrine::acquisition
