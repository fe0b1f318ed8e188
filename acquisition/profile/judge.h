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
  std::uint64_t frames = 0, rows = 0;  // rows with a stripe
  std::uint64_t saturated = 0, doubled = 0;
};

StripeCount count(std::span<const StripePoint> stripe);
StripeCount operator+(const StripeCount& a, const StripeCount& b);

// Fails (kBadInput) where hardly a frame shows a stripe ("no stripe"), where most of it is at the
// end of the camera's range ("all saturated") or where most rows have two ("two stripes").
Expected<void> judge(const StripeCount& scan);

// Fails (kBadInput) where all that the laser met lies at one height: the table itself ("empty
// turntable"), or nothing.
Expected<void> judge(std::span<const Profile> scan);

}  // namespace vitrine
