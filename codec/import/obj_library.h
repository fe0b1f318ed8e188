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
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// A statement of a map: the picture's name, and how its options place the picture. The name is
// empty if there is no map.
struct ObjMap {
  std::string name;
  std::array<float, 2> scale{1, 1}, offset{0, 0};  // of coordinates whose v = 0 is the bottom
  bool is_clamped = false;

  bool empty() const { return name.empty(); }
  // Returns the transform of coordinates whose v = 0 is the top.
  TextureTransform transform() const {
    return {.offset = {offset[0], 1.0 - scale[1] - offset[1]}, .scale = {scale[0], scale[1]}};
  }
  Wrap wrap() const { return is_clamped ? Wrap::kClamp : Wrap::kRepeat; }
};

// A material as a library states it.
struct ObjMaterial {
  std::optional<std::array<double, 3>> diffuse;  // Kd
  double opacity = 1;                            // d, or 1 - Tr
  double metallic = 0, roughness = 1;            // Pm, Pr
  Vec3 emission;                                 // Ke
  ObjMap diffuse_map;                            // map_Kd
  ObjMap opacity_map;                            // map_d
  ObjMap normal_map;                             // norm
  ObjMap bump_map;                               // map_Bump: a map of heights, but often of normals
  ObjMap emission_map;                           // map_Ke
  std::set<std::string_view> unread;             // statements of maps that are not read
};

using ObjLibrary = std::map<std::string, ObjMaterial, std::less<>>;  // key: name of the material

// Adds the materials of a library to `out`. A later statement replaces an earlier one.
void read_obj_library(std::span<const std::uint8_t> bytes, ObjLibrary& out);

// Removes blanks from the end of a name.
std::string_view without_end_blanks(std::string_view text);

}  // namespace vitrine::inline codec
