// SPDX-License-Identifier: Apache-2.0
// Reads the members of JSON objects, and reports each wrong member by its name.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "codec/core/bounds.h"
#include "server/metadata/presentation.h"

namespace vitrine::server {

inline constexpr double kMostLength = 1e12;  // largest absolute value of a coordinate

// Returns the N numbers of a JSON array. Returns nullopt if `json` is not an array of exactly N
// numbers, each from -most to most.
template <std::size_t N>
std::optional<std::array<double, N>> json_numbers(const nlohmann::json& json, double most) {
  std::array<double, N> out{};
  if (!json.is_array() || json.size() != N) return std::nullopt;
  for (std::size_t i = 0; i < N; ++i) {
    if (!json[i].is_number()) return std::nullopt;
    out[i] = json[i].get<double>();
    if (!(std::abs(out[i]) <= most)) return std::nullopt;
  }
  return out;
}

inline std::optional<Vec3> json_point(const nlohmann::json& json) {
  const auto p = json_numbers<3>(json, kMostLength);
  return p ? std::optional(Vec3{(*p)[0], (*p)[1], (*p)[2]}) : std::nullopt;
}

// Reads the members of a JSON object into values. A null resets a value to its default.
class JsonMembers {
 public:
  JsonMembers(const nlohmann::json& object, std::string prefix, const WrongField& wrong)
      : object_(object), prefix_(std::move(prefix)), wrong_(wrong) {}

  void only(std::initializer_list<std::string_view> known) const {
    for (const auto& [name, value] : object_.items()) {
      if (std::ranges::find(known, name) == known.end())
        wrong_(prefix_ + name, fmt::format("one of {}", fmt::join(known, ", ")));
    }
  }
  const nlohmann::json* find(const char* name) const {
    const auto found = object_.find(name);
    return found == object_.end() ? nullptr : &*found;
  }
  // Returns the members of the object `name`, which must exist.
  JsonMembers within(const char* name) const { return {*find(name), prefix_ + name + '.', wrong_}; }
  std::string name_of(const char* name) const { return prefix_ + name; }
  const WrongField& faults() const { return wrong_; }
  void wrong(const char* name, const std::string& expected) const {
    wrong_(prefix_ + name, expected);
  }
  void real(const char* name, double low, double high, double usual, double& value) const {
    const nlohmann::json* given = find(name);
    if (given == nullptr) return;
    if (given->is_null()) {
      value = usual;
    } else if (given->is_number() && *given >= low && *given <= high) {
      value = given->get<double>();
    } else {
      wrong(name, fmt::format("a number from {} to {}", low, high));
    }
  }
  // Reads an object by `read(members, value)`. A null removes the value.
  template <class Value, class Read>
  void object(const char* name, std::optional<Value>& value, const Read& read) const {
    const nlohmann::json* given = find(name);
    if (given == nullptr) return;
    if (given->is_null()) return value.reset();
    if (!given->is_object()) return wrong(name, "an object or null");
    if (!value) value.emplace();
    read(JsonMembers(*given, prefix_ + name + '.', wrong_), *value);
  }

 private:
  const nlohmann::json& object_;
  const std::string prefix_;
  const WrongField& wrong_;
};

}  // namespace vitrine::server
