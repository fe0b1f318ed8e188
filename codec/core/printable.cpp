// SPDX-License-Identifier: Apache-2.0
#include "codec/core/printable.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace vitrine::inline codec {
namespace {

struct CodePoints {
  std::uint32_t first, last;
};
// control characters, line separators, and marks that change the direction of text
constexpr std::array<CodePoints, 6> kControls{{{0, 0x1F},
                                               {0x7F, 0x9F},
                                               {0x200E, 0x200F},
                                               {0x2028, 0x202E},
                                               {0x2066, 0x2069},
                                               {0xFEFF, 0xFEFF}}};

// Returns the code point of a character. `size` is its utf8_size(), which is not 0.
std::uint32_t code_point(std::string_view text, std::size_t size) {
  const auto lead = static_cast<std::uint8_t>(text[0]);
  std::uint32_t code = size == 1 ? lead : lead & (0x7Fu >> size);
  for (std::size_t i = 1; i < size; ++i)
    code = code << 6 | (static_cast<std::uint8_t>(text[i]) & 0x3F);
  return code;
}

// Returns the length in bytes of a UTF-8 character whose first byte is `lead`, or 0 if no character
// starts with this byte.
std::size_t stated_size(std::uint8_t lead) {
  return lead < 0x80   ? 1
         : lead < 0xC2 ? 0
         : lead < 0xE0 ? 2
         : lead < 0xF0 ? 3
         : lead < 0xF5 ? 4
                       : 0;
}

}  // namespace

std::size_t utf8_size(std::string_view text) {
  if (text.empty()) return 0;
  const std::size_t size = stated_size(static_cast<std::uint8_t>(text[0]));
  if (size == 0 || size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((static_cast<std::uint8_t>(text[i]) & 0xC0) != 0x80) return 0;
  }
  constexpr std::array<std::uint32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  const std::uint32_t code = code_point(text, size);
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  return code < kSmallest[size] || code > 0x10FFFF || is_surrogate ? 0 : size;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t size = utf8_size(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
}

std::string printable_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t size = utf8_size(text);
    const std::uint32_t code = size > 0 ? code_point(text, size) : 0;
    const bool is_control = std::ranges::any_of(kControls, [&](const CodePoints& range) {
      return code >= range.first && code <= range.last;
    });
    if (is_control)
      out += '?';
    else
      out += text.substr(0, size);
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return out;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMostBytes = 60;
  std::size_t end = std::min(text.size(), kMostBytes);
  // The last character may begin up to three bytes before the cut and extend beyond it.
  for (std::size_t begin = end - std::min<std::size_t>(end, 3); begin < end; ++begin) {
    if (begin + utf8_size(text.substr(begin)) > end) end = begin;
  }
  return '\'' + printable_text(text.substr(0, end)) + '\'';
}

}  // namespace vitrine::inline codec
