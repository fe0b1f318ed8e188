// SPDX-License-Identifier: Apache-2.0
// Concatenates strings at compile time, for example the names in a table.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace vitrine::inline codec {

// A string of at most kMostBytes bytes. A longer one causes a compile error.
struct FixedText {
  static constexpr std::size_t kMostBytes = 512;
  std::array<char, kMostBytes> bytes{};
  std::size_t size = 0;

  constexpr operator std::string_view() const { return {bytes.data(), size}; }
  constexpr void append(std::string_view text) {
    for (const char c : text)
      bytes.at(size++) = c;
  }
};

template <class... Texts>
consteval FixedText concatenate(const Texts&... texts) {
  FixedText all;
  (all.append(texts), ...);
  return all;
}

// Joins the strings `of(row)` of all rows of a table. For example, the separator ", " and the last
// separator " or " give "PLY, GLB or OBJ".
template <class Table, class Of>
consteval FixedText join(const Table& table, Of of, std::string_view separator,
                         std::string_view last_separator) {
  FixedText all;
  const std::size_t count = std::size(table);
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) all.append(i + 1 == count ? last_separator : separator);
    all.append(of(table[i]));
  }
  return all;
}

}  // namespace vitrine::inline codec
