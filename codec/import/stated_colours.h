// SPDX-License-Identifier: Apache-2.0
// Converts colours that a file states as real numbers, either from 0 to 1 or from 0 to 255.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

using StatedColour = std::array<float, 3>;  // red, green and blue

// The entry of a vertex or face without a colour. It becomes white.
inline constexpr StatedColour kNoColour{std::numeric_limits<float>::quiet_NaN(), 0, 0};

// Whether all values are meant to be from 0 to 255 rather than from 0 to 1. A few values slightly
// above 1 do not count.
bool are_up_to_255(std::span<const StatedColour> stated);

// Converts the colours of a whole file. Adds a line to `repairs` if values beyond the range were
// clipped.
std::vector<Colour> to_colours(std::span<const StatedColour> stated,
                               std::vector<std::string>& repairs);

}  // namespace vitrine::inline codec
