// SPDX-License-Identifier: Apache-2.0
// Pictures of a laser stripe whose centre is known.
#pragma once

#include <cstdint>
#include <functional>

#include "acquisition/frame/frame.h"

namespace vitrine::acquisition {

struct StripeImage {
  int width = 320, height = 200;  // size of the picture, in pixels
  // Returns the stripe's u in a row, or NaN if the row has no stripe.
  std::function<double(double)> centre;
  double peak = 160, sigma = 2.5;  // grey levels at the stripe's peak; standard deviation in pixels
  double speckle = 0;              // contrast of the speckle, independent for each pixel
  double noise = 0;                // grey levels: standard deviation, independent in each picture
  double ambient = 0;              // grey levels of ambient light at full albedo, in both pictures
  std::function<double(double, double)> albedo = [](double, double) { return 1.; };
  std::function<double(double)> second;  // returns the centre of a second stripe, as `centre` does
  double second_peak = 0;
  std::uint64_t seed = 1;
};

struct FramePair {
  Frame lit, dark;
};

FramePair render(const StripeImage& image);

}  // namespace vitrine::acquisition
