// SPDX-License-Identifier: Apache-2.0
// Joins lines into a text of bounded size.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace vitrine::inline codec {

// Joins the lines with line feeds. The result has at most `most` bytes; `most` must be at least
// 128. Leaves out each line that does not fit. If lines are left out, the last line states their
// number.
inline std::string bounded_lines(std::span<const std::string> lines, std::size_t most) {
  constexpr std::size_t kReserve = 96;  // bytes for the line about the missing lines
  std::string text;
  std::size_t left_out = 0;
  const auto add = [&text](const std::string& line) {
    if (!text.empty()) text += '\n';
    text += line;
  };
  for (const std::string& line : lines) {
    if (text.size() + line.size() + kReserve < most) {
      add(line);
    } else {
      ++left_out;
    }
  }
  if (left_out > 0) add("… and " + std::to_string(left_out) + " more; `vitrine build` lists all");
  return text;
}

}  // namespace vitrine::inline codec
