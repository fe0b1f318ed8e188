// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_json.h"

#include <algorithm>
#include <cmath>

namespace vitrine::inline codec {
namespace {

const Json kNull;

}  // namespace

const Json& member(const Json& object, std::string_view key) {
  if (!object.is_object()) return kNull;
  const auto it = object.find(key);
  return it == object.end() ? kNull : *it;
}

const Json& element(const Json& document, std::string_view key, std::uint64_t index) {
  const Json& array = member(document, key);
  return array.is_array() && index < array.size() ? array[index] : kNull;
}

const Json& extension(const Json& object, std::string_view name) {
  return member(member(object, "extensions"), name);
}

std::uint64_t whole(const Json& object, std::string_view key, std::uint64_t otherwise) {
  const Json& value = member(object, key);
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  constexpr double kMost = 1ULL << 53;
  const double real = value.is_number_float() ? value.get<double>() : -1;
  const bool is_whole = real >= 0 && real <= kMost && real == std::floor(real);
  return is_whole ? static_cast<std::uint64_t>(real) : otherwise;
}

double real(const Json& object, std::string_view key, double otherwise) {
  const Json& value = member(object, key);
  return value.is_number() ? value.get<double>() : otherwise;
}

std::string text(const Json& object, std::string_view key, std::string_view otherwise) {
  const Json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string(otherwise);
}

bool are_numbers(const Json& array, std::size_t count) {
  return array.is_array() && array.size() == count &&
         std::ranges::all_of(array, [](const Json& entry) { return entry.is_number(); });
}

}  // namespace vitrine::inline codec
