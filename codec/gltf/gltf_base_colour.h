// SPDX-License-Identifier: Apache-2.0
// The base colours of glTF materials, from which vertex colours are computed. A base colour is a
// constant factor, multiplied by a texture if there is one. If a material only emits light, its
// emission serves as base colour.
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
  const Picture* picture = nullptr;  // null if the base colour has no texture
  GltfTexture texture;               // how the material uses the picture

  bool is_white() const { return picture == nullptr && factor == LinearColour{1, 1, 1}; }
  LinearColour at(double u, double v) const;  // (u, v): texture coordinates as stored in the file
};

class GltfBaseColours {
 public:
  // The references must outlive this object. `most_pixels` is the maximum number of pixels to
  // decode. A picture that fails to decode uses up this budget too: its pixels, and one more pixel
  // for each byte of its file.
  GltfBaseColours(const Json& document, GltfPictures& pictures, std::uint64_t most_pixels)
      : document_(document), pictures_(pictures), pixels_left_(most_pixels) {}

  // Returns the base colour of the primitive's material. BaseColour::picture is valid as long as
  // this object. If a picture cannot be decoded, passes the fault to GltfPictures::refuse().
  BaseColour of(const Json& primitive);

  // Returns the number of pictures that were decoded.
  std::size_t decoded() const;

 private:
  using SpanKey = std::pair<const std::uint8_t*, std::size_t>;

  const Picture* picture(std::uint64_t index);
  // Returns the picture of an image. If several images have the same bytes, they are decoded only
  // once.
  Expected<const Picture*> find(std::uint64_t index);
  Expected<Picture> decode(std::span<const std::uint8_t> bytes);

  const Json& document_;
  GltfPictures& pictures_;
  // key: index of the image; value: null if the image cannot be decoded
  std::map<std::uint64_t, const Picture*> decoded_;
  std::map<SpanKey, Expected<Picture>> by_span_;
  std::uint64_t pixels_left_;
};

}  // namespace vitrine::inline codec
