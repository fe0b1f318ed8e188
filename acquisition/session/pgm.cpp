// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/pgm.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace vitrine::acquisition {
namespace {

constexpr int kMaxSide = 1 << 15;

// Reads a number from 1 to kMaxSide and the character `after` from the front of `text`, and removes
// both. Returns the number, or 0 if there is none.
int take_number(std::string_view& text, char after) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const auto length = static_cast<std::size_t>(end - text.data());
  if (error != std::errc{} || length == text.size() || *end != after) return 0;
  text.remove_prefix(length + 1);
  return value >= 1 && value <= kMaxSide ? value : 0;
}

}  // namespace

std::vector<std::uint8_t> to_pgm(const Frame& frame) {
  const std::string head = fmt::format("P5\n{} {}\n255\n", frame.width, frame.height);
  std::vector<std::uint8_t> file(head.begin(), head.end());
  file.insert(file.end(), frame.pixels.begin(), frame.pixels.end());
  return file;
}

Expected<Frame> from_pgm(std::span<const std::uint8_t> file) {
  std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const bool is_pgm = text.starts_with("P5\n");
  if (is_pgm) text.remove_prefix(3);
  Frame frame;
  frame.width = take_number(text, ' '), frame.height = take_number(text, '\n');
  const std::size_t pixels = std::size_t(frame.width) * std::size_t(frame.height);
  if (!is_pgm || pixels == 0 || take_number(text, '\n') != 255 || text.size() != pixels)
    return fail(ErrorCode::kBadInput, "is not an 8-bit PGM picture of this scan; scan again");
  const auto first = file.end() - static_cast<std::ptrdiff_t>(pixels);
  frame.pixels.assign(first, file.end());
  return frame;
}

}  // namespace vitrine::acquisition
