// SPDX-License-Identifier: Apache-2.0
// The supported length units of model coordinates: "mm", "cm", "m" and "in".
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace vitrine::inline codec {

struct LengthUnit {
  std::string_view name;
  double metres;
};

inline constexpr std::array<LengthUnit, 4> kLengthUnits{
    {{"mm", 0.001}, {"cm", 0.01}, {"m", 1}, {"in", 0.0254}}};

// Returns the length of `unit` in metres, or nullopt if `unit` is empty or unknown.
constexpr std::optional<double> metres_per(std::string_view unit) {
  for (const LengthUnit& known : kLengthUnits) {
    if (known.name == unit) return known.metres;
  }
  return std::nullopt;
}

}  // namespace vitrine::inline codec
