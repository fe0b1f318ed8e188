// SPDX-License-Identifier: Apache-2.0
// From the stripe in the image to the profile about the table's axis (paper, eq. 1-2).
#pragma once

#include <span>

#include "acquisition/calibration/calibration.h"
#include "acquisition/profile/profile.h"
#include "acquisition/profile/stripe.h"

namespace vitrine {

// `angle`: degrees that the board has turned the table. The sense in which it turns is told by the
// calibrated axis and goes into Profile::theta, where angles grow counter-clockwise seen from
// above; nobody after this needs to know. Points outside the calibrated region are left out.
Profile profile_of(std::span<const StripePoint> stripe, const Calibration& calibration,
                   double angle);

}  // namespace vitrine
