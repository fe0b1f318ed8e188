// SPDX-License-Identifier: Apache-2.0
// A picture of the display atlas under construction. Stores, for each texel, the share of the texel
// that charts cover.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Red, green, blue and opacity, each 0 to 1. Colours are in linear light.
using TexelValue = std::array<float, 4>;

struct AtlasPicture {
  std::uint32_t side = 0;
  std::vector<TexelValue> texels;  // row by row from the top
  std::vector<float> covered;      // covered share of each texel, 0 to 1; 0: the texel has no value
};

// Returns the picture reduced to half the side, which must be even. Each texel is the mean of four
// texels, weighted by how much of each texel charts cover.
AtlasPicture halved(const AtlasPicture& picture);

// Fills the texels that no chart covers with a smooth continuation of the charts, by the push-pull
// method [GGSC96]. Smooth texels compress well, and viewers that interpolate across a chart's
// border show no false colours.
void fill_uncovered(AtlasPicture& picture);

// Returns the picture with one byte per channel. Converts colours to sRGB if `is_srgb`. Sets all
// opacities to 1 unless `has_opacity`.
Picture to_picture(const AtlasPicture& atlas, bool is_srgb, bool has_opacity);

}  // namespace vitrine::inline codec
