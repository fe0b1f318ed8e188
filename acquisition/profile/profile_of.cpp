// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/profile_of.h"

#include <cmath>

namespace vitrine::acquisition {
namespace {

// Wraps an angle to [0, 360). Replaces a tiny negative angle by 0, because adding 360 to it would
// round to 360.
double whole_turn(double degrees) {
  const double rest = std::fmod(degrees, 360), turned = rest < 0 ? rest + 360 : rest;
  return turned < 360 ? turned : 0;
}

}  // namespace

Profile profile_of(std::span<const StripePoint> stripe, const Calibration& calibration,
                   double angle) {
  Profile profile{whole_turn(calibration.axis.is_clockwise ? -angle : angle), {}};
  profile.points.reserve(stripe.size());
  for (const StripePoint& point : stripe) {
    if (const auto at = calibration.map.at(point.u, point.row))
      profile.points.push_back({about(calibration.axis, *at), point.row, point.flags});
  }
  return profile;
}

}  // namespace vitrine::acquisition
