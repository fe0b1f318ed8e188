// SPDX-License-Identifier: Apache-2.0
// A picture at decreasing resolutions, with which distant textures are drawn without aliasing
// [Williams83].
#pragma once

#include <array>
#include <vector>

#include "codec/mesh/texturing.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// The meaning of a picture's bytes: colours in sRGB, or plain values as in a normal map. Opacity is
// always a plain value.
enum class PictureCoding { kSrgb, kValues };

// Red, green, blue and opacity, each from 0 to 1. Colours are in linear light.
using Texel = std::array<float, 4>;

using ByteValues = std::array<float, 256>;

// Level 0 is the picture itself. Each further level has half the width and height, rounded down but
// at least 1. The last level has a single pixel. A pixel is the mean of the area that it covers in
// the previous level, in linear light, rounded to 8 bits as in graphics hardware.
class MipMap {
 public:
  // `picture` must have at least one pixel and outlive this object.
  MipMap(const Picture& picture, PictureCoding coding);
  MipMap(MipMap&&) = default;

  std::uint32_t width() const { return levels_[0]->width; }
  std::uint32_t height() const { return levels_[0]->height; }

  // Returns the value at (u, v), interpolated between pixel centres and between the two nearest
  // levels. `level` is clamped to the existing levels.
  Texel at(const TextureCoordinates& uv, double level, Wrap wrap_u, Wrap wrap_v) const;

  // Returns the value of the pixel of level 0 that contains (u, v).
  Texel nearest(const TextureCoordinates& uv, Wrap wrap_u, Wrap wrap_v) const;

 private:
  Texel interpolated(std::size_t level, const TextureCoordinates& uv, Wrap wrap_u,
                     Wrap wrap_v) const;

  // Maps a byte of red, green or blue to 0 to 1, in linear light if the picture is sRGB.
  const ByteValues* colours_;
  std::vector<Picture> smaller_;        // levels 1 and higher
  std::vector<const Picture*> levels_;  // pointers to all levels
};

}  // namespace vitrine::inline codec
