// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/steps.h"

#include <cmath>

namespace vitrine::acquisition {
namespace {

double distance(const Profile& strand, const ProfilePoint& point) {
  if (strand.points.empty()) return 0;
  const TablePoint &a = strand.points.back().at, &b = point.at;
  return std::hypot(a.rho - b.rho, a.lateral - b.lateral, a.z - b.z);
}

void add(const ProfilePoint& point, std::vector<Profile>& strands) {
  const bool to_second =
      strands.size() == 2 && distance(strands[1], point) < distance(strands[0], point);
  strands[to_second ? 1 : 0].points.push_back(point);
}

void add_two(const ProfilePoint& a, const ProfilePoint& b, std::vector<Profile>& strands) {
  if (strands.size() == 1) strands.push_back({strands[0].theta, {}});
  const bool crossed = distance(strands[0], b) + distance(strands[1], a) <
                       distance(strands[0], a) + distance(strands[1], b);
  strands[crossed ? 1 : 0].points.push_back(a);
  strands[crossed ? 0 : 1].points.push_back(b);
}

}  // namespace

std::vector<Profile> strands_of(const Profile& profile) {
  std::vector<Profile> strands{{profile.theta, {}}};
  const std::vector<ProfilePoint>& points = profile.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + 1 < points.size() && points[i + 1].row == points[i].row) {
      add_two(points[i], points[i + 1], strands);
      ++i;
    } else {
      add(points[i], strands);
    }
  }
  return strands;
}

}  // namespace vitrine::acquisition
