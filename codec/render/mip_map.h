// SPDX-License-Identifier: Apache-2.0
// A picture at falling resolutions, so that a texture seen from far does not alias [Williams83].
#pragma once

#include <array>
#include <vector>

#include "codec/mesh/texturing.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// The meaning of a picture's bytes: colours in sRGB, or values such as those of a normal map.
// Opacity is always a value.
enum class PictureCoding { kSrgb, kValues };

// Red, green, blue and opacity, each 0 to 1; colours in linear light.
using Texel = std::array<float, 4>;

using ByteValues = std::array<float, 256>;

// Level 0 is the picture itself. Each further level has half the width and height, rounded down and
// at least 1, down to a single pixel. A pixel is the mean of the area that it covers in the level
// before, in linear light, rounded to 8 bits, as graphics hardware stores it.
class MipMap {
 public:
  // `picture` must have at least one pixel and outlive this object.
  MipMap(const Picture& picture, PictureCoding coding);
  MipMap(MipMap&&) = default;

  std::uint32_t width() const { return levels_[0]->width; }
  std::uint32_t height() const { return levels_[0]->height; }

  // Returns the value at (u, v), interpolated between pixel centres and between the two levels
  // around `level`. `level` is clamped to the levels that exist.
  Texel at(const TextureCoordinates& uv, double level, Wrap wrap_u, Wrap wrap_v) const;

  // Returns the value of the pixel of level 0 that contains (u, v).
  Texel nearest(const TextureCoordinates& uv, Wrap wrap_u, Wrap wrap_v) const;

 private:
  Texel interpolated(std::size_t level, const TextureCoordinates& uv, Wrap wrap_u,
                     Wrap wrap_v) const;

  const ByteValues* colours_;           // values of the bytes of red, green and blue
  std::vector<Picture> smaller_;        // levels 1 and higher
  std::vector<const Picture*> levels_;  // all levels
};

}  // namespace vitrine::inline codec
