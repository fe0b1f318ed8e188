// SPDX-License-Identifier: Apache-2.0
#include "codec/export/statements.h"

#include "codec/files/companions.h"
#include "codec/format/bound_text.h"

namespace vitrine::inline codec {
namespace {

// Largest number of bytes in a statement's text. Some readers of PLY refuse lines of more than
// 1,023 bytes.
constexpr std::size_t kMostBytes = 400;

std::size_t character_bytes(std::string_view text) {
  std::size_t bytes = 1;
  while (bytes < text.size() && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80)
    ++bytes;
  return bytes;
}

// Whether a UTF-8 character is a control character (C0, DEL, C1), a line or paragraph separator, or
// one of the two other characters that XML forbids.
bool is_forbidden(std::string_view character) {
  if (character.size() == 1)
    return static_cast<unsigned char>(character[0]) < 0x20 || character[0] == 0x7F;
  return (character[0] == '\xC2' && character[1] < '\xA0') || character == "\u2028" ||
         character == "\u2029" || character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF";
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(" \\");
  return begin == text.npos || end == text.npos ? std::string()
                                                : text.substr(begin, end - begin + 1);
}

}  // namespace

std::string one_line(std::string_view text) {
  const std::string valid = as_utf8(text.substr(0, 8 * kMostBytes));
  std::string line;
  for (std::string_view left = valid; !left.empty();) {
    const std::string_view character = left.substr(0, character_bytes(left));
    if (line.size() + character.size() > kMostBytes) break;
    line += is_forbidden(character) ? " " : character;
    left.remove_prefix(character.size());
  }
  return trimmed(line);
}

std::vector<Statement> statements_of(const ExportOptions& options) {
  std::vector<Statement> all;
  const auto add = [&](std::string_view name, std::string_view text) {
    if (std::string line = one_line(text); !line.empty()) all.push_back({name, std::move(line)});
  };
  const FileDescription& about = options.about;
  // The unit comes first, because readers use the first unit that any comment states.
  add("unit", options.unit.empty() ? "unknown" : options.unit);
  if (options.up) add("up", name_of(*options.up));
  add("title", about.title);
  add("creator", about.creator);
  add("rights", about.rights);
  add("licence", about.licence);
  add("source", about.source);
  if (about.level) add("level", std::to_string(*about.level));
  if (about.error) add("error", bound_text(*about.error) + ' ' + std::string(options.unit));
  return all;
}

void put_comments(FileWriter& out, std::string_view prefix, std::span<const Statement> statements) {
  for (const auto& [name, text] : statements) {
    out.text(prefix), out.text(name), out.text(" "), out.text(text), out.text("\n");
  }
}

}  // namespace vitrine::inline codec
