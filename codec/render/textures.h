// SPDX-License-Identifier: Apache-2.0
// The textures of a mesh, ready for sampling: decoded pictures with their mip maps, and the texture
// maps of each material.
#pragma once

#include <optional>
#include <vector>

#include "codec/render/mip_map.h"
#include "codec/render/screen_triangle.h"

namespace vitrine::inline codec {

// A texture map on one face of the rendered picture. Texture coordinates are an affine function of
// the position in the face. The mip map level is therefore the same everywhere on the face.
class FaceTexture {
 public:
  // `map` says how the face uses `mip_map`. `corners` are the face's texture coordinates. `mip_map`
  // and `map` must outlive this object.
  FaceTexture(const MipMap& mip_map, const TextureMap& map,
              const std::array<TextureCoordinates, 3>& corners, const ScreenTriangle& triangle);

  // Texture coordinates of the corners, after the map's transform.
  const std::array<TextureCoordinates, 3>& corners() const { return corners_; }
  Texel at(const Barycentric& weights) const;

 private:
  const MipMap* mip_map_;
  const TextureMap* map_;
  std::array<TextureCoordinates, 3> corners_;
  // Mip map level at which neighbouring samples are at most one pixel apart ([GL46] section 8.14).
  double level_;
};

class Textures {
 public:
  // `pictures` are the decoded `texturing.pictures`, in the same order. A map whose picture has no
  // pixels is ignored.
  Textures(Texturing texturing, std::vector<Picture> pictures);

  // Whether every material has a white base colour and no base colour map.
  bool are_white() const { return are_white_; }
  const Material& material(std::uint32_t face) const {
    return texturing_.materials[texturing_.face_materials[face]];
  }
  // Returns a map of a face's material, or nullopt if the material has no such map.
  std::optional<FaceTexture> map(MapOfMaterial of, std::uint32_t face,
                                 const ScreenTriangle& triangle) const;

 private:
  using MipMaps = std::vector<std::optional<MipMap>>;  // one entry per picture

  static bool is_colour(MapOfMaterial map) {
    return map == &Material::base_colour_map || map == &Material::emission_map;
  }
  void add(MipMaps& mip_maps, const std::optional<TextureMap>& map, PictureCoding coding);

  Texturing texturing_;
  std::vector<Picture> pictures_;
  MipMaps colours_, values_;
  bool are_white_;
};

}  // namespace vitrine::inline codec
