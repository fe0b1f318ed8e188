// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace vitrine::acquisition {

std::vector<Profile> scan_of(const Shape& shape, const Scanned& how) {
  std::mt19937_64 random(how.seed);
  std::normal_distribution<double> normal;
  std::vector<Profile> profiles;
  for (int k = 0; k < how.profiles; ++k) {
    Profile profile{360. * k / how.profiles, {}};
    for (int row = 0; row < how.rows; ++row) {
      const double z = how.top + (how.bottom - how.top) * row / (how.rows - 1);
      const auto rho = shape(-profile.theta * std::numbers::pi / 180, z);
      if (rho) profile.points.push_back({{*rho + how.noise * normal(random), 0, z}, row});
    }
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

Shape cylinder(double radius) {
  return [=](double, double) { return radius; };
}

Shape ellipsoid(double across, double up, double height) {
  return [=](double, double z) -> std::optional<double> {
    const double h = (z - height) / up;
    if (std::abs(h) > 1) return {};
    return across * std::sqrt(1 - h * h);
  };
}

Shape box(double half) {
  return [=](double angle, double) {
    return half / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
  };
}

}  // namespace vitrine::acquisition
