// SPDX-License-Identifier: Apache-2.0
#include "codec/core/linear_colour.h"

#include "codec/core/srgb.h"

namespace vitrine::inline codec {
namespace {

std::array<double, 256> linear_light_of_bytes() {
  std::array<double, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = srgb_to_linear(static_cast<double>(i) / 255);
  return table;
}

}  // namespace

LinearColour to_linear(const Colour& srgb) {
  static const std::array<double, 256> table = linear_light_of_bytes();
  return {table[srgb[0]], table[srgb[1]], table[srgb[2]]};
}

Colour to_srgb(const LinearColour& linear) {
  Colour out;
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = to_byte(linear_to_srgb(linear[k]));
  return out;
}

std::vector<Colour> ColourMeans::take() const {
  std::vector<Colour> out(sums_.size(), Colour{255, 255, 255});
  for (std::size_t v = 0; v < out.size(); ++v) {
    if (counts_[v] > 0) out[v] = to_srgb(sums_[v] * (1.0 / counts_[v]));
  }
  return out;
}

}  // namespace vitrine::inline codec
