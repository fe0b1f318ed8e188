// SPDX-License-Identifier: Apache-2.0
#include "codec/import/stated_colours.h"

#include <algorithm>
#include <cmath>

#include "codec/core/linear_colour.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

bool is_stated(const StatedColour& colour) {
  return !std::isnan(colour[0]);
}

std::uint64_t count_above(std::span<const StatedColour> stated, float most) {
  std::uint64_t count = 0;
  for (const StatedColour& colour : stated)
    count += static_cast<std::uint64_t>(
        std::ranges::count_if(colour, [&](float part) { return part > most; }));
  return count;
}

}  // namespace

bool are_up_to_255(std::span<const StatedColour> stated) {
  constexpr float kMostOvershoot = 2;
  std::uint64_t above = 0, fractions = 0;
  float largest = 0;
  bool all_whole = true;
  for (const StatedColour& colour : stated) {
    if (!is_stated(colour)) continue;
    for (const float part : colour) {
      largest = std::max(largest, part);
      above += part > 1;
      fractions += part > 0 && part < 1;
      all_whole = all_whole && part == std::floor(part);
    }
  }
  if (largest <= 1 || all_whole) return largest > 1;
  return largest > kMostOvershoot && above >= fractions;
}

std::vector<Colour> to_colours(std::span<const StatedColour> stated,
                               std::vector<std::string>& repairs) {
  const bool is_wide = are_up_to_255(stated);
  const double scale = is_wide ? 1.0 / 255 : 1.0;
  std::vector<Colour> out;
  out.reserve(stated.size());
  for (const StatedColour& colour : stated) {
    const auto& [r, g, b] = colour;
    out.push_back(is_stated(colour)
                      ? Colour{to_byte(r * scale), to_byte(g * scale), to_byte(b * scale)}
                      : Colour{255, 255, 255});
  }
  const std::string most = is_wide ? "255" : "1";
  if (const auto clipped = count_above(stated, is_wide ? 255.F : 1.F); clipped > 0) {
    repairs.push_back(counted(clipped, "colour value") + " above " + most + " clipped to " + most +
                      "; export colours from 0 to " + most);
  }
  return out;
}

}  // namespace vitrine::inline codec
