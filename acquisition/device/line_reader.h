// SPDX-License-Identifier: Apache-2.0
// Splits arbitrary bytes from a controller into lines.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace vitrine::acquisition {

// Splits received bytes into lines. Lines end with a line feed. Carriage returns and empty lines
// are dropped. A `prompt` at the start of a line is a line of its own. A line that is longer than
// kLongest bytes, or has bytes other than printable ASCII, is returned as kGarbage.
class LineReader {
 public:
  static constexpr std::size_t kLongest = 128, kMostLines = 1024;
  static constexpr std::string_view kGarbage = "\x1a";

  explicit LineReader(char prompt = '\n') : prompt_(prompt) {}

  void feed(std::string_view bytes);
  std::optional<std::string> next();
  void clear();

 private:
  void end_line();

  char prompt_;
  bool is_garbage_ = false;
  std::string line_;
  std::deque<std::string> lines_;  // limited to kMostLines; the oldest lines are dropped
};

}  // namespace vitrine::acquisition
