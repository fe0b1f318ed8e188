// SPDX-License-Identifier: Apache-2.0
#include "server/store/text.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

namespace vitrine::server {
namespace {

// Returns the number of bytes of the character at the start of `text`; 0 if the character is
// malformed or not allowed.
std::size_t character_length(std::string_view text) noexcept {
  const auto lead = static_cast<std::uint8_t>(text[0]);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7F ? 1 : 0;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC0 || lead > 0xF7 || text.size() < length) return 0;
  std::uint32_t code = lead & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    const auto byte = static_cast<std::uint8_t>(text[i]);
    if ((byte & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte & 0x3F);
  }
  // The smallest allowed code point for each length. U+0080 to U+009F are control characters.
  constexpr std::uint32_t kSmallest[] = {0, 0, 0xA0, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  return code < kSmallest[length] || code > 0x10FFFF || is_surrogate ? 0 : length;
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

}  // namespace vitrine::server
