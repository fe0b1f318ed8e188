// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vitrine {

// The unit of length ("mm", "cm", "m", "in") that the comments at the head of a PLY, OBJ, STL or
// OFF file state, as in "comment unit mm", "# Units: millimeters" or "UNITS=mm"; empty where none
// does. What comes after the first 64 KB or the first line of data is not looked at.
std::string_view unit_in_comments(std::span<const std::uint8_t> file);

}  // namespace vitrine
