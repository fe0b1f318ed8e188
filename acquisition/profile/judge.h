// SPDX-License-Identifier: Apache-2.0
// Whether a scan shows what a scan has to show; if not, what the operator should do.
#pragma once

#include <cstdint>
#include <span>

#include "acquisition/profile/profile.h"
#include "acquisition/profile/stripe.h"
#include "codec/core/expected.h"

namespace vitrine {

// Of one frame, or summed up over many.
struct StripeCount {
  std::uint64_t frames = 0, rows = 0;  // rows with a stripe that the next one continues
  std::uint64_t saturated = 0, doubled = 0;
  std::uint64_t pixels = 0, full = 0;  // of the pictures, with and without laser; full: see below

  bool operator==(const StripeCount&) const = default;
};

StripeCount count(std::span<const StripePoint> stripe);
// The pixels of a picture alone, and those of them at the end of the camera's range. Where the
// picture without laser is full, the one with it shows no stripe, be the laser as bright as it may.
StripeCount count_full(const Frame& picture);
StripeCount operator+(const StripeCount& a, const StripeCount& b);
StripeCount sum(std::span<const StripeCount> counts);

// 0..1: of all rows of the pictures those without a stripe, of the others those that are saturated,
// and those that show two.
struct RowShares {
  double empty = 0, saturated = 0, doubled = 0;
};
// `height`: of a picture, pixels.
RowShares shares(const StripeCount& scan, int height);

// Whether there is something to measure.
bool shows_stripe(const StripeCount& scan);

// Fails (kBadInput) where the pictures are full ("over-exposed"), where hardly a frame shows a
// stripe ("no stripe"), where most of it is at the end of the camera's range ("all saturated") or
// where most rows show two lines ("two stripes").
Expected<void> judge(const StripeCount& scan);

// Fails (kBadInput) where all that the laser met lies at one height but for a few strays: the table
// itself ("empty turntable"), or nothing.
Expected<void> judge(std::span<const Profile> scan);

}  // namespace vitrine
