// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/sample.h"

#include <algorithm>
#include <cmath>

namespace vitrine::inline codec {
namespace {

std::uint32_t wrapped(std::int64_t i, std::uint32_t size, Wrap wrap) {
  const std::int64_t n = size;
  if (wrap == Wrap::kClamp)
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t period = wrap == Wrap::kMirror ? 2 * n : n;
  const std::int64_t at = (i % period + period) % period;
  return static_cast<std::uint32_t>(at < n ? at : 2 * n - 1 - at);
}

// Two neighbouring pixels along one axis. `weight` is the weight of the second pixel.
struct PixelPair {
  std::uint32_t first, second;
  double weight;
};

PixelPair pixels_around(double t, std::uint32_t size, Wrap wrap) {
  constexpr double kFar = 1e9;
  const double x = (std::abs(t) < kFar ? t : 0) * size - 0.5;
  const double floor = std::floor(x);
  const auto i = static_cast<std::int64_t>(floor);
  return {wrapped(i, size, wrap), wrapped(i + 1, size, wrap), x - floor};
}

}  // namespace

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
