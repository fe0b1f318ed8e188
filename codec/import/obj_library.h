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
#include "codec/files/companions.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// A texture map of a material: the picture's path, and how options scale and move the picture. The
// path is empty if there is no map.
struct ObjMap {
  std::string name;
  std::string_view folder;                         // the library's folder (see StatedPath)
  std::array<float, 2> scale{1, 1}, offset{0, 0};  // for coordinates with v = 0 at the bottom
  bool is_clamped = false;

  bool empty() const { return name.empty(); }
  StatedPath path() const { return {name, folder}; }
  // Returns the transform for coordinates with v = 0 at the top of the picture.
  TextureTransform transform() const {
    return {.offset = {offset[0], 1.0 - scale[1] - offset[1]}, .scale = {scale[0], scale[1]}};
  }
  Wrap wrap() const { return is_clamped ? Wrap::kClamp : Wrap::kRepeat; }
};

// A material as stated in a material library. DAE and FBX materials have the same properties.
struct ObjMaterial {
  std::optional<std::array<double, 3>> diffuse;  // MTL statement Kd
  std::string_view diffuse_fault;                // the loss or correction of `diffuse`, or empty
  double opacity = 1;                            // MTL statement d, or 1 - Tr
  double metallic = 0, roughness = 1;            // MTL statements Pm and Pr
  Vec3 emission;                                 // MTL statement Ke
  ObjMap diffuse_map;                            // MTL statement map_Kd
  ObjMap opacity_map;                            // MTL statement map_d
  ObjMap normal_map;                             // MTL statement norm
  ObjMap bump_map;                               // map_Bump: a height map, but often a normal map
  ObjMap emission_map;                           // MTL statement map_Ke
  std::set<std::string_view> unread;             // map statements that are not read
  // The names of the opacity map and the bump map in messages.
  std::string_view opacity_map_name = "map_d", bump_map_name = "map_Bump";
};

using ObjLibrary = std::map<std::string, ObjMaterial, std::less<>>;  // key: name of the material

// Adds the materials of a library to `out`. `folder` is the library's folder (see StatedPath). Its
// characters must outlive `out`, whose maps keep a view of them. If a material occurs twice, later
// statements replace earlier ones. If the diffuse colours of the library range from 0 to 255,
// scales them to the range 0 to 1.
void read_obj_library(std::span<const std::uint8_t> bytes, std::string_view folder,
                      ObjLibrary& out);

// Returns `text` without blanks at its end.
std::string_view without_end_blanks(std::string_view text);

// Returns a name without the quotation marks around it, if there are any.
std::string_view without_quotes(std::string_view name);

}  // namespace vitrine::inline codec
