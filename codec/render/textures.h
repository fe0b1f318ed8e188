// SPDX-License-Identifier: Apache-2.0
// The textures of a mesh, ready to be sampled: decoded pictures with their mip maps, and the maps
// of each material.
#pragma once

#include <optional>
#include <vector>

#include "codec/render/mip_map.h"
#include "codec/render/screen_triangle.h"

namespace vitrine::inline codec {

// A map on one face of a picture of the model. The texture coordinates are affine in the face, so
// the direction and the length of a step in the texture are the same everywhere on it.
class FaceTexture {
 public:
  // `map` tells how the face uses `mip_map`; `corners` are its texture coordinates. Both references
  // must outlive this object.
  FaceTexture(const MipMap& mip_map, const TextureMap& map,
              const std::array<TextureCoordinates, 3>& corners, const ScreenTriangle& triangle);

  // Texture coordinates of the corners after the map's transform.
  const std::array<TextureCoordinates, 3>& corners() const { return corners_; }
  Texel at(const Barycentric& weights) const;

 private:
  const MipMap* mip_map_;
  const TextureMap* map_;
  std::array<TextureCoordinates, 3> corners_;
  double level_;  // of the mip map, where a step of one sample is at most one pixel long ([GL46]
                  // section 8.14)
};

class Textures {
 public:
  // `pictures` are the decoded `texturing.pictures`, in the same order. Maps whose picture has no
  // pixels are ignored.
  Textures(Texturing texturing, std::vector<Picture> pictures);

  // Whether the materials give no face a base colour: all factors are white, and none has a map.
  bool are_white() const { return are_white_; }
  const Material& material(std::uint32_t face) const {
    return texturing_.materials[texturing_.face_materials[face]];
  }
  // Return the maps of a face's material, or nullopt if it has no such map.
  std::optional<FaceTexture> base_colour(std::uint32_t face, const ScreenTriangle& triangle) const;
  std::optional<FaceTexture> normals(std::uint32_t face, const ScreenTriangle& triangle) const;

 private:
  using MipMaps = std::vector<std::optional<MipMap>>;  // per picture

  void add(MipMaps& mip_maps, const std::optional<TextureMap>& map, PictureCoding coding);
  std::optional<FaceTexture> texture(const MipMaps& mip_maps, const std::optional<TextureMap>& map,
                                     std::uint32_t face, const ScreenTriangle& triangle) const;

  Texturing texturing_;
  std::vector<Picture> pictures_;
  MipMaps colours_, normals_;
  bool are_white_;
};

}  // namespace vitrine::inline codec
