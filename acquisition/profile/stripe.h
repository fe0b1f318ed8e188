// SPDX-License-Identifier: Apache-2.0
// Finds the laser's stripe in an image. Each row gets one point, or two if it shows two surfaces,
// at sub-pixel precision across the stripe.
#pragma once

#include <vector>

#include "acquisition/frame/frame.h"
#include "acquisition/profile/profile.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

enum class StripeMethod {
  kDerivativeOfGaussian,  // zero of the smoothed image's derivative; albedo edges shift it little
  kCentreOfMass,          // centre of mass of the grey levels around the peak
  kBlaisRioux,            // [BR86]: zero of a fourth-order difference; for thin stripes
};

struct StripeOptions {
  StripeMethod method = StripeMethod::kDerivativeOfGaussian;
  // Standard deviation, in pixels, of the stripe's cross section; also the basis of the filter's
  // width.
  double width = 2.5;
  double contrast = 6;  // least height of a peak, in standard deviations of the picture's noise
  // A point is averaged with at most this many rows on either side, because speckle moves single
  // rows by tenths of a pixel. Only rows that lie on a common line, within the stripe's own noise,
  // are averaged, so edges and detail stay. 0 disables averaging.
  int steady_rows = 4;

  bool operator==(const StripeOptions&) const = default;
};

struct StripePoint {
  int row = 0;             // image row, in pixels; ascending, and at most two points share a row
  double u = 0;            // column, in pixels
  double strength = 0;     // grey levels above the background, after smoothing
  std::uint8_t flags = 0;  // combination of PointFlag values
};

// Finds the stripe that `lit` (laser on) shows and `dark` (laser off) does not. Rows without a
// stripe are left out. If a row has two peaks, the peak that continues the stripe of the
// neighbouring rows comes first. This peak is flagged kDouble if the other peak has similar
// strength. The other peak follows, flagged kSecond, if it continues over several rows. The row
// then shows two surfaces, one behind the other. Fails with kBadInput if the frames differ in size.
Expected<std::vector<StripePoint>> find_stripe(const Frame& lit, const Frame& dark,
                                               const StripeOptions& options = {});

}  // namespace vitrine::acquisition
