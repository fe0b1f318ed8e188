// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/sample.h"

#include "codec/picture/pixel_pair.h"

namespace vitrine::inline codec {

LinearColour sample(const Picture& picture, double u, double v, Wrap wrap_u, Wrap wrap_v) {
  const PixelPair x = pixels_around(u, picture.width, wrap_u),
                  y = pixels_around(v, picture.height, wrap_v);
  const auto row = [&](std::uint32_t at) {
    return to_linear(picture.at(x.first, at)) * (1 - x.weight) +
           to_linear(picture.at(x.second, at)) * x.weight;
  };
  return row(y.first) * (1 - y.weight) + row(y.second) * y.weight;
}

}  // namespace vitrine::inline codec
