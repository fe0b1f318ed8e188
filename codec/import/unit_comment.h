// SPDX-License-Identifier: Apache-2.0
// Finds the unit of length that a mesh file states in its comments.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vitrine::inline codec {

// Returns the unit ("mm", "cm", "m" or "in") stated in the comments at the start of a PLY, OBJ, STL
// or OFF file, such as "comment unit mm", "# Units: millimeters" or "UNITS=mm". Returns an empty
// text if no comment states a unit. The search ends after 64 KB or at the first line of data.
std::string_view unit_in_comments(std::span<const std::uint8_t> file);

}  // namespace vitrine::inline codec
