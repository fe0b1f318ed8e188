// SPDX-License-Identifier: Apache-2.0
// Where the laser's stripe is in an image: one point a row, sub-pixel across the stripe.
#pragma once

#include <vector>

#include "acquisition/frame/frame.h"
#include "acquisition/profile/profile.h"
#include "codec/core/expected.h"

namespace vitrine {

enum class StripeMethod {
  kDerivativeOfGaussian,  // zero of the smoothed image's derivative: little moved by albedo edges
  kCentreOfMass,          // of the grey levels about the peak
  kBlaisRioux,            // zero of a fourth order difference: for thin stripes
};

struct StripeOptions {
  StripeMethod method = StripeMethod::kDerivativeOfGaussian;
  double width = 2.5;  // pixels: standard deviation of the stripe's cross section, and the filter's
  double contrast = 6;  // how many times the picture's noise a peak stands out at least
  // Rows on either side that a point may be averaged with. Speckle moves a single row by tenths of
  // a pixel; rows are averaged along their common line as far as they lie on one within the noise
  // of this very stripe, so that edges and detail stay. 0: each row alone.
  int steady_rows = 4;

  bool operator==(const StripeOptions&) const = default;
};

struct StripePoint {
  int row = 0;             // pixels; ascending, up to two points have the same
  double u = 0;            // pixels
  double strength = 0;     // grey levels above the background, smoothed
  std::uint8_t flags = 0;  // PointFlag
};

// The stripe in `lit` (laser on) that is not in `dark` (laser off). Rows without one are left out.
// Of two peaks in a row the one that continues the rows around comes first, flagged kDouble if the
// other is about as strong. The other follows, flagged kSecond, if it is part of a line over
// several rows: two surfaces, one behind the other. Fails (kBadInput) where the frames differ in
// size.
Expected<std::vector<StripePoint>> find_stripe(const Frame& lit, const Frame& dark,
                                               const StripeOptions& options = {});

}  // namespace vitrine
