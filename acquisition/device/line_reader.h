// SPDX-License-Identifier: Apache-2.0
// Cuts what a controller sends into lines, whatever it sends.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace vitrine {

// Lines end with a line feed; carriage returns and empty lines are dropped. A `prompt` at the start
// of a line is a line of its own. A line of more than kLongest bytes, or with bytes that are not
// printable ASCII, is handed out as kGarbage.
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
  bool garbage_ = false;
  std::string line_;
  std::deque<std::string> lines_;  // the oldest are dropped above kMostLines
};

}  // namespace vitrine
