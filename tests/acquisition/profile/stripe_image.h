// SPDX-License-Identifier: Apache-2.0
// Pictures of a laser stripe whose centre is known.
#pragma once

#include <cstdint>
#include <functional>

#include "acquisition/frame/frame.h"

namespace vitrine {

struct StripeImage {
  int width = 320, height = 200;         // pixels
  std::function<double(double)> centre;  // u over the row; NaN: no stripe there
  double peak = 160, sigma = 2.5;        // grey levels; pixels
  double speckle = 0;                    // contrast, of each pixel for itself
  double noise = 0;                      // grey levels, of each picture
  double ambient = 0;                    // grey levels at full albedo, in both pictures
  std::function<double(double, double)> albedo = [](double, double) { return 1.; };  // of (u, v)
  std::function<double(double)> second;  // another stripe's centre
  double second_peak = 0;
  std::uint64_t seed = 1;
};

struct FramePair {
  Frame lit, dark;
};

FramePair render(const StripeImage& image);

}  // namespace vitrine
