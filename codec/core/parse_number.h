// SPDX-License-Identifier: Apache-2.0
// Numbers in text that people and other programs write.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace vitrine {

// The number that all of `text` is, in decimal digits. Nothing where it is empty, anything else
// stands before, in or after it ("+1", " 1", "1x"), or it does not fit.
template <class Number>
std::optional<Number> parse_number(std::string_view text) noexcept {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [at, fault] = std::from_chars(text.data(), end, value);
  if (fault != std::errc{} || at != end) return std::nullopt;
  return value;
}

}  // namespace vitrine
