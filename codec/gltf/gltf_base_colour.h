// SPDX-License-Identifier: Apache-2.0
// The base colours of glTF materials, for vertex colours. Each is a factor, optionally multiplied
// by a texture.
#pragma once

#include <map>
#include <span>
#include <utility>

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
  // The references must outlive this object. Decodes at most `most_pixels` pixels. Pictures that
  // cannot be decoded count as well: with their pixels, and one pixel per byte for the search.
  GltfBaseColours(const Json& document, GltfPictures& pictures, std::uint64_t most_pixels)
      : document_(document), pictures_(pictures), pixels_left_(most_pixels) {}

  // Returns the base colour of the primitive's material. The colour's picture lives as long as this
  // object. A picture that cannot be decoded is refused.
  BaseColour of(const Json& primitive);

  // Returns the number of pictures that were decoded.
  std::size_t decoded() const;

 private:
  using Place = std::pair<const std::uint8_t*, std::size_t>;

  const Picture* picture(std::uint64_t index);
  // Returns the picture of an image, decoded once for all images with the same bytes.
  Expected<const Picture*> find(std::uint64_t index);
  Expected<Picture> decode(std::span<const std::uint8_t> bytes);

  const Json& document_;
  GltfPictures& pictures_;
  // key: index of the image; value: null if the image cannot be decoded
  std::map<std::uint64_t, const Picture*> decoded_;
  std::map<Place, Expected<Picture>> by_place_;
  std::uint64_t pixels_left_;
};

}  // namespace vitrine::inline codec
