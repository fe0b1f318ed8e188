// SPDX-License-Identifier: Apache-2.0
// Decides whether a scan shows an object and a usable stripe. If not, the error says what the
// operator should do.
#pragma once

#include <cstdint>
#include <span>

#include "acquisition/profile/profile.h"
#include "acquisition/profile/stripe.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

// Counts for one frame, or their sum over many frames.
struct StripeCount {
  // `rows` counts the rows with a stripe that continues in the next row.
  std::uint64_t frames = 0, rows = 0;
  std::uint64_t saturated = 0, doubled = 0;
  // `pixels` counts the pixels of all pictures, with and without laser. `full` counts those at the
  // end of the camera's range.
  std::uint64_t pixels = 0, full = 0;

  bool operator==(const StripeCount&) const = default;
};

StripeCount count(std::span<const StripePoint> stripe);
// Counts the pixels of a picture, and those at the end of the camera's range. A picture that is
// full even without laser cannot show the stripe.
StripeCount count_full(const Frame& picture);
StripeCount operator+(const StripeCount& a, const StripeCount& b);
StripeCount sum(std::span<const StripeCount> counts);

// Shares from 0 to 1. `empty` is the share of rows without a stripe. `saturated` and `doubled` are
// shares of the rows with a stripe: saturated rows, and rows with two stripes.
struct RowShares {
  double empty = 0, saturated = 0, doubled = 0;
};
// `height` is the height of a picture, in pixels.
RowShares shares(const StripeCount& scan, int height);

// Returns whether the scan shows a stripe that can be measured.
bool shows_stripe(const StripeCount& scan);

// Judges the counts of a scan. Fails with kBadInput if the pictures are full ("over-exposed"),
// hardly any frame shows a stripe ("no stripe"), most of the stripe is at the end of the camera's
// range ("all saturated"), or most rows show two stripes ("two stripes").
Expected<void> judge(const StripeCount& scan);

// Judges the profiles of a scan. Fails with kBadInput ("empty turntable") if all points but a few
// outliers lie at one height, as on the bare table.
Expected<void> judge(std::span<const Profile> scan);

}  // namespace vitrine::acquisition
