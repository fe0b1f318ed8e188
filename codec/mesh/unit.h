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

// A unit of kLengthUnits, and the factor that converts the file's coordinates to it.
struct StatedLength {
  std::string_view unit;
  double scale;
};

// Returns the unit of kLengthUnits that is `metres` long, with the factor 1. If there is none,
// returns "m" with the factor `metres`. Replaces an impossible length by `usual`.
constexpr StatedLength stated_length(double metres, double usual) {
  constexpr double kTolerance = 1e-4;
  if (!(metres > 0 && metres < 1e9)) metres = usual;
  for (const LengthUnit& known : kLengthUnits) {
    const double ratio = metres / known.metres;
    if (ratio > 1 - kTolerance && ratio < 1 + kTolerance) return {known.name, 1};
  }
  return {"m", metres};
}

}  // namespace vitrine::inline codec
