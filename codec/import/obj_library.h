// SPDX-License-Identifier: Apache-2.0
// Parses OBJ material libraries (MTL).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// A material as a library states it. Names of maps are empty if there is no map.
struct ObjMaterial {
  std::optional<std::array<double, 3>> diffuse;  // Kd
  double opacity = 1;                            // d, or 1 - Tr
  double metallic = 0, roughness = 1;            // Pm, Pr
  Vec3 emission;                                 // Ke
  std::string diffuse_map;                       // map_Kd
  std::string opacity_map;                       // map_d
  std::string normal_map;                        // norm
  std::string bump_map;                          // map_Bump: a map of heights, but often of normals
  std::string emission_map;                      // map_Ke
  std::set<std::string_view> unread;             // statements of maps that are not read
};

using ObjLibrary = std::map<std::string, ObjMaterial, std::less<>>;  // key: name of the material

// Adds the materials of a library to `out`. A later statement replaces an earlier one.
void read_obj_library(std::span<const std::uint8_t> bytes, ObjLibrary& out);

// Removes blanks from the end of a name.
std::string_view without_end_blanks(std::string_view text);

}  // namespace vitrine::inline codec
