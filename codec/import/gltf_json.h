// SPDX-License-Identifier: Apache-2.0
// Reading of glTF's JSON that never throws, whatever the document holds.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine {

using Json = nlohmann::json;

// The member `key`, or null where `object` is no object or has none.
const Json& member(const Json& object, std::string_view key);

// Element `index` of the array `key` of the document, or null.
const Json& element(const Json& document, std::string_view key, std::uint64_t index);

// The object of an extension by its name, or null.
const Json& extension(const Json& object, std::string_view name);

// A member as a whole number from 0, `otherwise` where it is absent or something else.
std::uint64_t whole(const Json& object, std::string_view key, std::uint64_t otherwise);

inline constexpr std::uint64_t kAbsent = ~std::uint64_t{0};

double real(const Json& object, std::string_view key, double otherwise);
std::string text(const Json& object, std::string_view key, std::string_view otherwise);

// Whether it is an array of `count` numbers.
bool are_numbers(const Json& array, std::size_t count);

// The numbers of an array of exactly N, or `otherwise`.
template <std::size_t N>
std::array<double, N> numbers(const Json& array, const std::array<double, N>& otherwise) {
  if (!are_numbers(array, N)) return otherwise;
  std::array<double, N> out;
  for (std::size_t i = 0; i < N; ++i)
    out[i] = array[i].template get<double>();
  return out;
}

}  // namespace vitrine
