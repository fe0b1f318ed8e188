// SPDX-License-Identifier: Apache-2.0
// Reads the JSON of glTF files. Unexpected contents never throw an exception.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

using Json = nlohmann::json;

// Returns the member `key`, or null if `object` is not an object or has no such member.
const Json& member(const Json& object, std::string_view key);

// Returns element `index` of the document's array `key`, or null if it does not exist.
const Json& element(const Json& document, std::string_view key, std::uint64_t index);

// Returns the JSON object of the extension `name` in `object`, or null if there is none.
const Json& extension(const Json& object, std::string_view name);

// Returns the member `key` if it is a non-negative integer, which may be written as 3.0; otherwise
// returns `otherwise`.
std::uint64_t whole(const Json& object, std::string_view key, std::uint64_t otherwise);

inline constexpr std::uint64_t kAbsent = ~std::uint64_t{0};

double real(const Json& object, std::string_view key, double otherwise);
std::string text(const Json& object, std::string_view key, std::string_view otherwise);

// Whether `array` is a JSON array of exactly `count` numbers.
bool are_numbers(const Json& array, std::size_t count);

// Returns the numbers of `array` if it consists of exactly N numbers; otherwise returns
// `otherwise`.
template <std::size_t N>
std::array<double, N> numbers(const Json& array, const std::array<double, N>& otherwise) {
  if (!are_numbers(array, N)) return otherwise;
  std::array<double, N> out;
  for (std::size_t i = 0; i < N; ++i)
    out[i] = array[i].template get<double>();
  return out;
}

}  // namespace vitrine::inline codec
