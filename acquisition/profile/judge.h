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
  // `rows` counts the rows whose stripe continues in the row before or after.
  std::uint64_t frames = 0, rows = 0;
  std::uint64_t saturated = 0, doubled = 0;
  // `pixels` counts the pixels of all pictures, with and without laser. `full` counts the pixels at
  // the end of the camera's range.
  std::uint64_t pixels = 0, full = 0;

  bool operator==(const StripeCount&) const = default;
};

StripeCount count(std::span<const StripePoint> stripe);
// Counts all pixels of a picture, and the pixels at the end of the camera's range. A picture that
// is saturated even without laser cannot show the stripe.
StripeCount count_full(const Frame& picture);
StripeCount operator+(const StripeCount& a, const StripeCount& b);
StripeCount sum(std::span<const StripeCount> counts);

// `empty` is the share of all rows that have no stripe. `saturated` is the share of saturated rows
// among the rows with a stripe. `doubled` is the share of rows with two stripes among the rows with
// a stripe. All shares are from 0 to 1.
struct RowShares {
  double empty = 0, saturated = 0, doubled = 0;
};
// `height` is the height of a picture, in pixels.
RowShares shares(const StripeCount& scan, int height);

// Returns whether the scan shows a stripe that can be measured.
bool shows_stripe(const StripeCount& scan);

// Judges the counts of a scan. Fails with kBadInput and one of these messages:
//   "over-exposed": too many pixels are at the end of the camera's range.
//   "no stripe": hardly any frame shows a stripe.
//   "all saturated": most of the stripe is at the end of the range.
//   "two stripes": most rows show two stripes.
Expected<void> judge(const StripeCount& scan);

// Judges the profiles of a scan. Fails with kBadInput ("empty turntable") if all points except a
// few outliers lie at one height, as on an empty table.
Expected<void> judge(std::span<const Profile> scan);

}  // namespace vitrine::acquisition
