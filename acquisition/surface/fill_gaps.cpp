// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/fill_gaps.h"

#include <cmath>

namespace vitrine {
namespace {

double distance(const TablePoint& a, const TablePoint& b) {
  return std::hypot(a.rho - b.rho, a.lateral - b.lateral, a.z - b.z);
}

// The plane's far side of the axis is another side of the object.
bool are_apart(const TablePoint& a, const TablePoint& b, const Spacing& spacing) {
  return (a.rho < 0) != (b.rho < 0) || !are_joined(a.rho, b.rho, distance(a, b), spacing) ||
         std::hypot(a.lateral - b.lateral, a.z - b.z) > spacing.bridge;
}

ProfilePoint between(const ProfilePoint& a, const ProfilePoint& b, int row) {
  const double t = static_cast<double>(row - a.row) / (b.row - a.row);
  const auto mix = [t](double x, double y) { return x + t * (y - x); };
  return {{mix(a.at.rho, b.at.rho), mix(a.at.lateral, b.at.lateral), mix(a.at.z, b.at.z)},
          row,
          kFilled};
}

}  // namespace

std::uint64_t fill_gaps(Profile& profile, double largest_hole, const Spacing& spacing) {
  std::vector<ProfilePoint> points;
  points.reserve(profile.points.size());
  std::uint64_t filled = 0;
  for (ProfilePoint point : profile.points) {
    point.flags &= static_cast<std::uint8_t>(~kApart);
    if (!points.empty()) {
      const ProfilePoint last = points.back();
      if (are_apart(last.at, point.at, spacing)) {
        point.flags |= kApart;
      } else if (distance(last.at, point.at) <= largest_hole) {
        for (int row = last.row + spacing.rows; row < point.row; row += spacing.rows, ++filled)
          points.push_back(between(last, point, row));
      }
    }
    points.push_back(point);
  }
  profile.points = std::move(points);
  return filled;
}

}  // namespace vitrine
