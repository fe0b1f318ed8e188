// SPDX-License-Identifier: Apache-2.0
// Finds the length unit that a mesh file states in its comments.

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "codec/import/readers.h"
#include "codec/mesh/unit.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kMostHeadBytes = 1 << 16;
constexpr std::string_view kBetweenWords{" \t\r:=,;()\"'\0", 12};

struct Spelling {
  std::string_view word, unit;
};

constexpr std::array<Spelling, 19> kSpellings{{{"mm", "mm"},
                                               {"millimeter", "mm"},
                                               {"millimeters", "mm"},
                                               {"millimetre", "mm"},
                                               {"millimetres", "mm"},
                                               {"cm", "cm"},
                                               {"centimeter", "cm"},
                                               {"centimeters", "cm"},
                                               {"centimetre", "cm"},
                                               {"centimetres", "cm"},
                                               {"m", "m"},
                                               {"meter", "m"},
                                               {"meters", "m"},
                                               {"metre", "m"},
                                               {"metres", "m"},
                                               {"in", "in"},
                                               {"inch", "in"},
                                               {"inches", "in"},
                                               {"unknown", ""}}};

std::optional<std::string_view> unit_named(std::string_view word) {
  const auto it = std::ranges::find(kSpellings, word, &Spelling::word);
  return it == kSpellings.end() ? std::nullopt : std::optional(it->unit);
}

std::string take_lower_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBetweenWords), line.size()));
  std::string word(line.substr(0, line.find_first_of(kBetweenWords)));
  line.remove_prefix(word.size());
  for (char& c : word)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return word;
}

// Whether another word follows on the line, rather than a punctuation mark or the line end.
bool continues(std::string_view line) {
  const std::size_t next = line.find_first_not_of(" \t\r");
  return next != line.npos && kBetweenWords.find(line[next]) == kBetweenWords.npos;
}

// Returns the unit that follows the word "unit" or "units" in a comment, such as "mm", "is mm",
// "are in inches" or "= 1 mm". Returns an empty string if the unit is "unknown", and nullopt if no
// unit follows. The word "in" does not mean inches if another word follows it, as in "in world
// space".
std::optional<std::string_view> unit_after(std::string_view line) {
  std::string word = take_lower_word(line);
  for (const std::string_view filler : {"is", "are", "1"}) {
    if (word == filler) word = take_lower_word(line);
  }
  const bool is_preposition = word == "in" && continues(line);
  const auto unit = unit_named(word), after = unit_named(take_lower_word(line));
  return is_preposition ? after : unit;
}

std::optional<std::string_view> unit_in_line(std::string_view line) {
  while (!line.empty()) {
    const std::string word = take_lower_word(line);
    if (word != "unit" && word != "units") continue;
    if (const auto unit = unit_after(line)) return unit;
  }
  return std::nullopt;
}

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

std::string_view unit_in_ply(std::string_view head) {
  while (!head.empty()) {
    const std::string_view line = take_line(head);
    if (line == "end_header") break;
    if (!line.starts_with("comment") && !line.starts_with("obj_info")) continue;
    if (const auto unit = unit_in_line(line)) return *unit;
  }
  return {};
}

// Searches the `#` comments above the first line of data. In OFF, the keyword comes before the
// comments.
std::string_view unit_in_hash_comments(std::string_view head) {
  while (!head.empty()) {
    const std::string_view line = take_line(head);
    if (is_off_keyword(line) || line.empty()) continue;
    if (!line.starts_with('#')) break;
    if (const auto unit = unit_in_line(line.substr(1))) return *unit;
  }
  return {};
}

}  // namespace

std::string_view unit_in_comments(std::span<const std::uint8_t> file) {
  const std::string_view head(reinterpret_cast<const char*>(file.data()),
                              std::min(file.size(), kMostHeadBytes));
  if (is_ply(file)) return unit_in_ply(head);
  if (is_binary_stl(file)) return unit_in_line(head.substr(0, 80)).value_or("");
  if (head.starts_with("solid"))
    return unit_in_line(head.substr(0, head.find_first_of("\r\n"))).value_or("");
  return unit_in_hash_comments(head);
}

}  // namespace vitrine::inline codec
