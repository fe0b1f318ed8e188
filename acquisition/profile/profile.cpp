// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/profile.h"

#include <cmath>
#include <numbers>

namespace vitrine::acquisition {

Vec3 position(const Profile& profile, const ProfilePoint& point) {
  const double theta = profile.theta * std::numbers::pi / 180;
  const double c = std::cos(theta), s = std::sin(theta);
  const auto& [rho, lateral, z] = point.at;
  return {rho * c + lateral * s, lateral * c - rho * s, z};
}

}  // namespace vitrine::acquisition
