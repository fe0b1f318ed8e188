// SPDX-License-Identifier: Apache-2.0
// The base colours of glTF materials, for vertex colours. Each is a factor, optionally multiplied
// by a texture.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "codec/core/linear_colour.h"
#include "codec/gltf/gltf_pictures.h"
#include "codec/gltf/gltf_texture.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

struct BaseColour {
  LinearColour factor{1, 1, 1};
  const Picture* picture = nullptr;  // null if there is only the factor
  GltfTexture texture;               // the use of the picture

  bool is_white() const { return picture == nullptr && factor == LinearColour{1, 1, 1}; }
  LinearColour at(double u, double v) const;  // (u, v): texture coordinates as in the file
};

class GltfBaseColours {
 public:
  // The references must outlive this object. Decodes at most `most_pixels` pixels.
  GltfBaseColours(const Json& document, GltfPictures& pictures, std::uint64_t most_pixels)
      : document_(document), pictures_(pictures), pixels_left_(most_pixels) {}

  // Returns the base colour of the primitive's material. The colour's picture lives as long as this
  // object. A picture that cannot be decoded is refused.
  BaseColour of(const Json& primitive);

  // Returns the number of pictures that were decoded.
  std::size_t decoded() const;

 private:
  const Picture* picture(std::uint64_t index);
  Expected<Picture> decode(std::uint64_t index);

  const Json& document_;
  GltfPictures& pictures_;
  // key: index of the image; value: nullopt if the image cannot be decoded
  std::map<std::uint64_t, std::optional<Picture>> decoded_;
  std::uint64_t pixels_left_;
};

}  // namespace vitrine::inline codec
