// SPDX-License-Identifier: Apache-2.0
// Texturing of a mesh: materials, pictures, and texture coordinates per face corner, as in the file
// that they come from.
//
// Texture coordinates belong to face corners, not to vertices: a vertex on the border of two charts
// has different coordinates in each. The connectivity of the mesh ignores these borders.
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

// A position in a picture: (0, 0) is its upper left corner, (1, 1) its lower right corner. Values
// outside [0, 1] are allowed. The reader has replaced values that are not finite with 0.
using TextureCoordinates = std::array<float, 2>;

// A picture as the file has it: PNG, JPEG or WebP.
struct EncodedPicture {
  std::string name;  // of the file or the element that it comes from; may be empty
  std::vector<std::uint8_t> bytes;
};

// How to treat a coordinate outside [0, 1).
enum class Wrap : std::uint8_t { kRepeat, kMirror, kClamp };

// Maps texture coordinates before they are used, as the glTF extension KHR_texture_transform does.
struct TextureTransform {
  std::array<double, 2> offset{0, 0}, scale{1, 1};
  double rotation = 0;  // radians, counter-clockwise

  // Returns the position in the picture for the coordinates (u, v) of the file: scales, then
  // rotates about (0, 0), then shifts.
  std::array<double, 2> at(double u, double v) const {
    const double c = std::cos(rotation), s = std::sin(rotation);
    const double x = scale[0] * u, y = scale[1] * v;
    return {offset[0] + c * x + s * y, offset[1] + c * y - s * x};
  }
};

// A material's use of a picture.
struct TextureMap {
  std::uint32_t picture = 0;     // index into Texturing::pictures
  std::uint8_t coordinates = 0;  // index into Texturing::coordinates
  bool is_nearest = false;       // sampled without interpolation
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  TextureTransform transform;
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

// A material in glTF's model: metallic-roughness. Factors multiply the maps' values. Colours are
// linear.
struct Material {
  std::string name;
  std::array<double, 4> base_colour{1, 1, 1, 1};  // red, green, blue, opacity
  double metallic = 0, roughness = 1;             // 0 to 1
  double normal_scale = 1, occlusion_strength = 1;
  Vec3 emission{0, 0, 0};  // red, green, blue; may exceed 1
  // Map of base colours (sRGB, with opacity).
  std::optional<TextureMap> base_colour_map;
  // Map of normals in tangent space, as glTF has them: green points up in the picture.
  std::optional<TextureMap> normal_map;
  // Map of roughness (green channel) and metallic (blue channel).
  std::optional<TextureMap> metallic_roughness_map;
  std::optional<TextureMap> occlusion_map;  // red channel
  std::optional<TextureMap> emission_map;   // sRGB
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  double alpha_cutoff = 0.5;  // with kMask: smaller opacities are invisible
  bool is_double_sided = false;
  bool is_unlit = false;
};

// Calls visit(map) for each map of a material.
template <class Visit>
void for_each_map(const Material& material, Visit visit) {
  for (const auto map :
       {&Material::base_colour_map, &Material::normal_map, &Material::metallic_roughness_map,
        &Material::occlusion_map, &Material::emission_map}) {
    if (material.*map) visit(*(material.*map));
  }
}

// Number of sets of texture coordinates that a mesh can have.
inline constexpr std::size_t kCoordinateSets = 2;

// The texturing of a mesh. Empty if it has no materials. Otherwise every face has a material.
struct Texturing {
  std::vector<Material> materials;
  std::vector<EncodedPicture> pictures;
  std::vector<std::uint16_t> face_materials;  // per face: index into `materials`
  // Per set and face: the coordinates of the three corners. Sets that no map uses are empty.
  std::array<std::vector<std::array<TextureCoordinates, 3>>, kCoordinateSets> coordinates;

  bool empty() const { return materials.empty(); }
};

}  // namespace vitrine::inline codec
