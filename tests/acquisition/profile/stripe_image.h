// SPDX-License-Identifier: Apache-2.0
// Pictures of a laser stripe whose centre is known.
#pragma once

#include <cstdint>
#include <functional>

#include "acquisition/frame/frame.h"

namespace vitrine::acquisition {

struct StripeImage {
  int width = 320, height = 200;  // pixels of the picture
  // Returns u for each row. NaN means no stripe in that row.
  std::function<double(double)> centre;
  double peak = 160, sigma = 2.5;  // grey levels at the stripe's peak; standard deviation in pixels
  double speckle = 0;              // contrast, independent for each pixel
  double noise = 0;                // grey levels, independent for each pixel of each picture
  double ambient = 0;              // grey levels at full albedo, in both pictures
  std::function<double(double, double)> albedo = [](double, double) {
    return 1.;
  };                                     // albedo at (u, v)
  std::function<double(double)> second;  // centre of a second stripe
  double second_peak = 0;
  std::uint64_t seed = 1;
};

struct FramePair {
  Frame lit, dark;
};

FramePair render(const StripeImage& image);

}  // namespace vitrine::acquisition
