// SPDX-License-Identifier: Apache-2.0
#include "server/messages/download_name.h"

#include <fmt/format.h>

#include "server/content/percent_encoding.h"

namespace vitrine::server {
namespace {

constexpr std::size_t kMaxTitleBytes = 120;

bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
}

bool is_ascii(char c) {
  return static_cast<unsigned char>(c) < 0x80;
}

bool is_unsafe(char c) {
  return (is_ascii(c) && static_cast<unsigned char>(c) < 0x20) || c == 0x7F ||
         std::string_view("/\\:*?\"<>|%;").find(c) != std::string_view::npos;
}

// Whether a character of several bytes is a control character (U+0080 to U+009F), a line separator,
// or a character that changes the direction of text. The direction could disguise the extension.
bool is_unseen(std::string_view character) {
  if (character.size() == 2)
    return character == "\u061C" || (character[0] == '\xC2' && character[1] < '\xA0');
  return (character >= "\u200B" && character <= "\u200F") ||
         (character >= "\u2028" && character <= "\u202E") ||
         (character >= "\u2060" && character <= "\u206F") || character == "\uFEFF";
}

// Returns the length in bytes of the first character of `text`.
std::size_t first_character(std::string_view text) {
  std::size_t length = 1;
  while (length < text.size() && continues_character(text[length]))
    ++length;
  return length;
}

std::string safe_title(std::string_view title) {
  std::string out;
  while (!title.empty()) {
    const std::string_view character = title.substr(0, first_character(title));
    if (out.size() + character.size() > kMaxTitleBytes) break;
    const bool is_kept = character.size() == 1 ? !is_unsafe(character[0]) : !is_unseen(character);
    out += is_kept ? character : "_";
    title.remove_prefix(character.size());
  }
  const std::size_t begin = out.find_first_not_of(" ."), end = out.find_last_not_of(" .");
  return begin == out.npos ? std::string() : out.substr(begin, end - begin + 1);
}

// Returns the text with `_` for each character that is not ASCII.
std::string in_ascii(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (is_ascii(c)) out += c;
    if (!is_ascii(c) && !continues_character(c)) out += '_';
  }
  return out;
}

}  // namespace

std::string attachment_named(std::string_view title, std::string_view fallback,
                             std::string_view extension) {
  std::string stem = safe_title(title);
  if (stem.empty()) stem = fallback;
  const std::string ascii = in_ascii(stem);
  std::string value = fmt::format("attachment; filename=\"{}.{}\"", ascii, extension);
  if (ascii != stem) {
    value += fmt::format("; filename*=UTF-8''{}.{}", percent_encoded(stem), extension);
  }
  return value;
}

}  // namespace vitrine::server
