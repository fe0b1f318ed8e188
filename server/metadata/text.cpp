// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "codec/core/bounded_lines.h"
#include "codec/core/printable.h"

namespace vitrine::server {
namespace {

// Returns the number of bytes of the character at the start of `text`; 0 if the character is
// malformed or not allowed.
std::size_t character_length(std::string_view text) noexcept {
  const auto lead = static_cast<std::uint8_t>(text[0]);
  if (lead < 0x20 || lead == 0x7F) return 0;
  const std::size_t size = utf8_size(text);
  // U+0080 to U+009F are control characters, too.
  const bool is_control = size == 2 && lead == 0xC2 && static_cast<std::uint8_t>(text[1]) < 0xA0;
  return is_control ? 0 : size;
}

}  // namespace

bool is_plain_text(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string as_plain_text(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length > 0) {
      plain += text.substr(0, length);
    } else {
      plain += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text[0]));
    }
    text.remove_prefix(length > 0 ? length : 1);
  }
  return plain;
}

bool is_line(std::string_view text) noexcept {
  return text.size() <= kMaxLineBytes && is_plain_text(text);
}

bool is_paragraphs(std::string_view text) noexcept {
  if (text.size() > kMaxParagraphBytes) return false;
  for (std::size_t end = 0; (end = text.find('\n')) != text.npos; text.remove_prefix(end + 1))
    if (!is_plain_text(text.substr(0, end))) return false;
  return is_plain_text(text);
}

std::string joined_lines(std::span<const std::string> lines) {
  std::vector<std::string> plain;
  for (const std::string& line : lines)
    plain.push_back(as_plain_text(line));
  return bounded_lines(plain, kMaxParagraphBytes);
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, length));
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return lines;
}

}  // namespace vitrine::server
