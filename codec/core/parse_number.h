// SPDX-License-Identifier: Apache-2.0
// Parses decimal numbers from untrusted text.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace vitrine::inline codec {

// Parses all of `text` as a decimal number. Returns nullopt if `text` is empty, if it contains
// anything besides the number ("+1", " 1", "1x"), or if the number is out of range.
template <class Number>
std::optional<Number> parse_number(std::string_view text) noexcept {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [at, fault] = std::from_chars(text.data(), end, value);
  if (fault != std::errc{} || at != end) return std::nullopt;
  return value;
}

}  // namespace vitrine::inline codec
