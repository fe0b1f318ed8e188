// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/cloud.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vitrine {
namespace {

constexpr double kDepths = 4;       // of s_max: eq. 5
constexpr double kOutermost = .95;  // of the points lie closer to the axis than what spacing is of

template <class T>
T percentile(std::vector<T>& values, double part) {
  if (values.empty()) return {};
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double median_step(const std::vector<Profile>& profiles) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < profiles.size(); ++k)
    steps.push_back(profiles[k].theta - profiles[k - 1].theta);
  return percentile(steps, .5) * std::numbers::pi / 180;
}

}  // namespace

Cloud::Cloud(std::vector<Profile> given) : profiles(std::move(given)) {
  std::ranges::stable_sort(profiles, {}, &Profile::theta);
  first.push_back(0);
  for (const Profile& profile : profiles) {
    for (const ProfilePoint& point : profile.points)
      positions.push_back(position(profile, point));
    first.push_back(positions.size());
  }
}

std::vector<Profile> keep(const Cloud& cloud, const std::vector<bool>& kept) {
  std::vector<Profile> profiles;
  for (std::size_t k = 0; k < cloud.profiles.size(); ++k) {
    const Profile& from = cloud.profiles[k];
    Profile to{from.theta, {}};
    for (std::size_t i = 0; i < from.points.size(); ++i) {
      if (kept[cloud.first[k] + i]) to.points.push_back(from.points[i]);
    }
    profiles.push_back(std::move(to));
  }
  return profiles;
}

Spacing spacing_of(const Cloud& cloud, const SurfaceOptions& options) {
  std::vector<double> along, radii;
  std::vector<int> rows;
  for (const Profile& profile : cloud.profiles) {
    for (std::size_t i = 0; i < profile.points.size(); ++i) {
      const ProfilePoint& p = profile.points[i];
      radii.push_back(std::hypot(p.at.rho, p.at.lateral));
      if (i == 0) continue;
      const ProfilePoint& q = profile.points[i - 1];
      rows.push_back(p.row - q.row);
      along.push_back(std::hypot(p.at.rho - q.at.rho, p.at.z - q.at.z));
    }
  }
  Spacing spacing;
  spacing.rows = std::max(1, percentile(rows, .5));
  spacing.largest = options.largest_spacing > 0
                        ? options.largest_spacing
                        : std::max(percentile(along, .5),
                                   median_step(cloud.profiles) * percentile(radii, kOutermost));
  spacing.bridge = std::max(kDepths * spacing.largest, options.largest_hole);
  spacing.cos_largest = std::cos(options.largest_angle * std::numbers::pi / 180);
  return spacing;
}

bool are_joined(double rho_a, double rho_b, double distance, const Spacing& spacing) {
  const double depth = std::abs(rho_a - rho_b);
  if (depth < kDepths * spacing.largest) return true;
  const double across = std::sqrt(std::max(0., distance * distance - depth * depth));
  return across > spacing.cos_largest * distance;
}

}  // namespace vitrine
