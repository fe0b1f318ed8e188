// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/profile_of.h"

#include <cmath>

namespace vitrine {

Profile profile_of(std::span<const StripePoint> stripe, const Calibration& calibration,
                   double angle) {
  const double turned = std::fmod(calibration.axis.clockwise ? -angle : angle, 360);
  Profile profile{turned < 0 ? turned + 360 : turned, {}};
  profile.points.reserve(stripe.size());
  for (const StripePoint& point : stripe) {
    if (const auto at = calibration.map.at(point.u, point.row))
      profile.points.push_back({about(calibration.axis, *at), point.row, point.flags});
  }
  return profile;
}

}  // namespace vitrine
