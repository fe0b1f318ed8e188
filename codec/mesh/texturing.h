// SPDX-License-Identifier: Apache-2.0
// Texturing of a mesh, as in its file: materials, pictures, and texture coordinates per face
// corner.
//
// Texture coordinates belong to face corners, not to vertices: a vertex on the border of two charts
// has different coordinates in each chart. The connectivity of the mesh ignores these borders.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// A position in a picture: (0, 0) is the upper left corner, (1, 1) the lower right corner. Values
// outside [0, 1] are allowed. Values are finite: the reader replaces all others by 0.
using TextureCoordinates = std::array<float, 2>;

// A picture in its encoded form: PNG, JPEG or WebP.
struct EncodedPicture {
  std::string name;  // name of the picture's file or element; may be empty
  std::vector<std::uint8_t> bytes;
};

// How a texture coordinate outside [0, 1) is mapped to the picture.
enum class Wrap : std::uint8_t { kRepeat, kMirror, kClamp };

// A transform of texture coordinates, like the glTF extension KHR_texture_transform.
struct TextureTransform {
  std::array<double, 2> offset{0, 0}, scale{1, 1};
  double rotation = 0;  // radians, counter-clockwise

  // Returns the position in the picture for the file's coordinates (u, v). Scales, then rotates
  // about (0, 0), then adds the offset.
  std::array<double, 2> at(double u, double v) const {
    const double c = std::cos(rotation), s = std::sin(rotation);
    const double x = scale[0] * u, y = scale[1] * v;
    return {offset[0] + c * x + s * y, offset[1] + c * y - s * x};
  }
};

// How a material uses a picture.
struct TextureMap {
  std::uint32_t picture = 0;     // index into Texturing::pictures
  std::uint8_t coordinates = 0;  // index into Texturing::coordinates
  bool is_nearest = false;       // whether the picture is sampled without interpolation
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  TextureTransform transform;
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

// A material in glTF's metallic-roughness model. Factors are multiplied by the values of maps.
// Colours are in linear light.
struct Material {
  std::string name;
  std::array<double, 4> base_colour{1, 1, 1, 1};  // red, green, blue, opacity
  double metallic = 0, roughness = 1;             // 0 to 1
  double normal_scale = 1, occlusion_strength = 1;
  Vec3 emission{0, 0, 0};  // red, green, blue; may exceed 1
  // Map of base colours in sRGB, with opacity.
  std::optional<TextureMap> base_colour_map;
  // Tangent-space normal map, as in glTF: green points up in the picture.
  std::optional<TextureMap> normal_map;
  // Map of roughness (green channel) and metallic (blue channel) values.
  std::optional<TextureMap> metallic_roughness_map;
  std::optional<TextureMap> occlusion_map;  // values in the red channel
  std::optional<TextureMap> emission_map;   // colours in sRGB
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  double alpha_cutoff = 0.5;  // if the mode is kMask, points of smaller opacity are invisible
  bool is_double_sided = false;
  bool is_unlit = false;
};

using MapOfMaterial = std::optional<TextureMap> Material::*;
inline constexpr std::array<MapOfMaterial, 5> kMapsOfMaterial = {
    &Material::base_colour_map, &Material::normal_map, &Material::metallic_roughness_map,
    &Material::occlusion_map, &Material::emission_map};

// Calls visit(map) for each map of a material.
template <class Visit>
void for_each_map(const Material& material, Visit visit) {
  for (const MapOfMaterial map : kMapsOfMaterial) {
    if (material.*map) visit(*(material.*map));
  }
}

// Maximum number of sets of texture coordinates per mesh.
inline constexpr std::size_t kCoordinateSets = 2;

// The texturing of a mesh. The texturing is empty if the mesh has no materials. Otherwise every
// face has a material.
struct Texturing {
  std::vector<Material> materials;
  std::vector<EncodedPicture> pictures;
  std::vector<std::uint16_t> face_materials;  // per face: index into `materials`
  // Per set and face: the texture coordinates of the three corners. A set that no map uses is
  // empty.
  std::array<std::vector<std::array<TextureCoordinates, 3>>, kCoordinateSets> coordinates;

  bool empty() const { return materials.empty(); }
};

}  // namespace vitrine::inline codec
