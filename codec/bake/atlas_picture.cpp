// SPDX-License-Identifier: Apache-2.0
#include "codec/bake/atlas_picture.h"

#include <algorithm>
#include <cmath>

#include "codec/core/srgb.h"

namespace vitrine::inline codec {
namespace {

// Returns the picture reduced to half the side, rounded up.
AtlasPicture pushed(const AtlasPicture& picture) {
  AtlasPicture out;
  const std::uint32_t side = picture.side;
  out.side = (side + 1) / 2;
  out.texels.resize(std::size_t{out.side} * out.side);
  out.covered.resize(out.texels.size());
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::size_t from = std::size_t{y} * side + x;
      const std::size_t to = std::size_t{y / 2} * out.side + x / 2;
      const float weight = picture.covered[from];
      for (std::size_t k = 0; k < 4; ++k)
        out.texels[to][k] += weight * picture.texels[from][k];
      out.covered[to] += weight;
    }
  }
  for (std::size_t i = 0; i < out.texels.size(); ++i) {
    if (out.covered[i] == 0) continue;
    for (float& value : out.texels[i])
      value /= out.covered[i];
  }
  return out;
}

// Interpolates the value at texel (x, y) from `coarse`, which has half as many texels per side.
TexelValue pulled(const AtlasPicture& coarse, std::uint32_t x, std::uint32_t y) {
  const std::uint32_t last = coarse.side - 1;
  const auto beside = [last](std::uint32_t i) {
    return i % 2 == 0 ? (i / 2 == 0 ? 0 : i / 2 - 1) : std::min(i / 2 + 1, last);
  };
  const std::size_t near_row = std::size_t{y / 2} * coarse.side;
  const std::size_t far_row = std::size_t{beside(y)} * coarse.side;
  const auto &a = coarse.texels[near_row + x / 2], &b = coarse.texels[near_row + beside(x)],
             &c = coarse.texels[far_row + x / 2], &d = coarse.texels[far_row + beside(x)];
  TexelValue out;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = (9 * a[k] + 3 * b[k] + 3 * c[k] + d[k]) / 16;
  return out;
}

}  // namespace

AtlasPicture halved(const AtlasPicture& picture) {
  AtlasPicture out = pushed(picture);
  for (float& covered : out.covered)
    covered /= 4;
  return out;
}

Picture to_picture(const AtlasPicture& atlas, bool is_srgb, bool has_opacity) {
  Picture picture{atlas.side, atlas.side, {}};
  picture.pixels.reserve(4 * atlas.texels.size());
  const auto byte = [](double value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
  };
  for (const TexelValue& texel : atlas.texels) {
    for (std::size_t k = 0; k < 3; ++k)
      picture.pixels.push_back(byte(is_srgb ? linear_to_srgb(texel[k]) : texel[k]));
    picture.pixels.push_back(has_opacity ? byte(texel[3]) : 255);
  }
  return picture;
}

void fill_uncovered(AtlasPicture& picture) {
  if (picture.side <= 1) return;
  AtlasPicture coarse = pushed(picture);
  for (float& covered : coarse.covered)
    covered = std::min(covered, 1.0f);
  fill_uncovered(coarse);
  for (std::uint32_t y = 0; y < picture.side; ++y) {
    for (std::uint32_t x = 0; x < picture.side; ++x) {
      const std::size_t i = std::size_t{y} * picture.side + x;
      if (picture.covered[i] == 0) picture.texels[i] = pulled(coarse, x, y);
    }
  }
}

}  // namespace vitrine::inline codec
