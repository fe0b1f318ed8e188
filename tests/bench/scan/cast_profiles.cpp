// SPDX-License-Identifier: Apache-2.0
#include "cast_profiles.h"

#include <algorithm>
#include <random>

#include "acquisition/rig_optics/solid.h"
#include "support/product_names.h"

namespace vitrine::bench {

std::vector<Profile> cast_profiles(const TriangleMesh& object, int steps, double row_mm) {
  constexpr double kOutside = 200;  // mm from the axis, outside all objects
  const rig::Solid solid(object);
  const auto height = [](const Vec3& p) { return p.z; };
  const double top = std::ranges::max_element(object.positions, {}, height)->z;
  std::vector<Profile> profiles;
  for (int step = 0; step < steps; ++step) {
    Profile profile{360.0 * step / steps, {}};
    const Vec3 outwards = position(profile, {{.rho = 1}});
    for (int row = 0; row * row_mm < top; ++row) {
      const double z = top - (row + 0.5) * row_mm;
      const auto hit = solid.first_hit(outwards * kOutside + Vec3{0, 0, z}, outwards * -1);
      const double rho = hit ? dot(hit->at, outwards) : 0;
      if (rho > 0) profile.points.push_back({{rho, 0, z}, row, 0});
    }
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

void add_noise(std::vector<Profile>& profiles, double deviation) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, deviation);
  for (Profile& profile : profiles) {
    for (ProfilePoint& point : profile.points)
      point.at.rho += noise(random);
  }
}

}  // namespace vitrine::bench
