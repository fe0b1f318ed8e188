// SPDX-License-Identifier: Apache-2.0
// Converts colours that a file states as real numbers. Their range is either 0 to 1 or 0 to 255.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

using StatedColour = std::array<float, 3>;  // red, green and blue

// Stands for a vertex or face without a colour. Such a vertex or face becomes white.
inline constexpr StatedColour kNoColour{std::numeric_limits<float>::quiet_NaN(), 0, 0};

// Whether the values of a file range from 0 to 255 rather than from 0 to 1. A few values slightly
// above 1 still count as the range 0 to 1.
bool are_up_to_255(std::span<const StatedColour> stated);

// Converts all colours of a file. Adds a line to `repairs` if values out of range were clipped.
std::vector<Colour> to_colours(std::span<const StatedColour> stated,
                               std::vector<std::string>& repairs);

}  // namespace vitrine::inline codec
