// SPDX-License-Identifier: Apache-2.0
// Converts the stripe in an image to a profile about the table's axis. Source: [WLL] eq. 1 and 2.
#pragma once

#include <span>

#include "acquisition/calibration/calibration.h"
#include "acquisition/profile/profile.h"
#include "acquisition/profile/stripe.h"

namespace vitrine::acquisition {

// `angle` is the angle, in degrees, by which the motor board has turned the table. Profile::theta
// always grows counter-clockwise, seen from above, even if the calibrated axis says that the table
// turns clockwise. Points outside the calibrated region are left out.
Profile profile_of(std::span<const StripePoint> stripe, const Calibration& calibration,
                   double angle);

}  // namespace vitrine::acquisition
