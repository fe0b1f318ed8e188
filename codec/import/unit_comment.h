// SPDX-License-Identifier: Apache-2.0
// Finds the length unit that a mesh file states in its comments.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vitrine::inline codec {

// Returns the unit that a comment states: "mm", "cm", "m" or "in". The comment must be at the start
// of the file: in the first 64 KB, and before the first line of data. Examples of comments are
// "comment unit mm", "# Units: millimeters" and "UNITS=mm". The file may be PLY, OBJ, STL
// or OFF. Returns an empty string if no comment states a unit.
std::string_view unit_in_comments(std::span<const std::uint8_t> file);

}  // namespace vitrine::inline codec
