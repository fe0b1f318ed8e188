// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/stripe_image.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace vitrine::acquisition {
namespace {

double bell(double x, double sigma) {
  return std::isnan(x) ? 0 : std::exp(-x * x / (2 * sigma * sigma));
}

std::uint8_t level(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0., 255.)));
}

}  // namespace

FramePair render(const StripeImage& image) {
  std::mt19937_64 random(image.seed);
  std::normal_distribution<double> normal;
  const auto size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  FramePair pair{{image.width, image.height, {}}, {image.width, image.height, {}}};
  pair.lit.pixels.reserve(size), pair.dark.pixels.reserve(size);
  for (int v = 0; v < image.height; ++v) {
    const double centre = image.centre(v), second = image.second ? image.second(v) : NAN;
    for (int u = 0; u < image.width; ++u) {
      const double albedo = image.albedo(u, v);
      double laser = image.peak * bell(u - centre, image.sigma) +
                     image.second_peak * bell(u - second, image.sigma);
      if (image.speckle > 0 && laser > .1)
        laser *= std::max(0., 1 + image.speckle * normal(random));
      const auto noise = [&] { return image.noise > 0 ? image.noise * normal(random) : 0; };
      pair.lit.pixels.push_back(level(albedo * (laser + image.ambient) + 8 + noise()));
      pair.dark.pixels.push_back(level(albedo * image.ambient + 8 + noise()));
    }
  }
  return pair;
}

}  // namespace vitrine::acquisition
