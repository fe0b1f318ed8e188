// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/steps.h"

#include <cmath>

namespace vitrine::acquisition {
namespace {

double distance(const TablePoint& a, const TablePoint& b) {
  return std::hypot(a.rho - b.rho, a.lateral - b.lateral, a.z - b.z);
}

bool same_side(const TablePoint& a, const TablePoint& b) {
  return (a.rho < 0) == (b.rho < 0);
}

class Course {
 public:
  Course(const std::vector<ProfilePoint>& points, const Spacing& spacing)
      : points_(points), spacing_(spacing) {}

  // Returns whether the surface continues from the point before `i` to point `i`. If the two rho
  // have different signs, the points lie on different sides of the object, and the surface does not
  // continue.
  bool continues(std::size_t i) const {
    const TablePoint &a = points_[i - 1].at, &b = points_[i].at;
    if (!same_side(a, b)) return false;
    return are_joined(std::abs(b.rho - a.rho), distance(a, b), spacing_) || is_steady(i, i - 1) ||
           is_steady(i, i + 1);
  }

 private:
  // Returns whether the depth changes steadily at point `i`. The change from the point before `i`
  // to `i` must resemble the change from the point before `other` to `other`. On a surface at a
  // grazing angle, these changes are large but similar.
  bool is_steady(std::size_t i, std::size_t other) const {
    if (other == 0 || other >= points_.size()) return false;
    const ProfilePoint &a = points_[i - 1], &b = points_[i], &c = points_[other - 1],
                       &d = points_[other];
    if (!same_side(c.at, d.at)) return false;
    const double slope = (d.at.rho - c.at.rho) / (d.row - c.row);
    const double depth = std::abs(b.at.rho - a.at.rho - slope * (b.row - a.row));
    return are_joined(depth, distance(a.at, b.at), spacing_) &&
           distance(c.at, d.at) < spacing_.bridge;
  }

  const std::vector<ProfilePoint>& points_;
  const Spacing& spacing_;
};

ProfilePoint between(const ProfilePoint& a, const ProfilePoint& b, int row) {
  const double t = static_cast<double>(row - a.row) / (b.row - a.row);
  const auto mix = [t](double x, double y) { return x + t * (y - x); };
  return {{mix(a.at.rho, b.at.rho), mix(a.at.lateral, b.at.lateral), mix(a.at.z, b.at.z)},
          row,
          kFilled};
}

std::uint64_t fill(const ProfilePoint& a, const ProfilePoint& b, int step,
                   std::vector<ProfilePoint>& points) {
  std::uint64_t filled = 0;
  for (int row = a.row + step; row < b.row; row += step, ++filled)
    points.push_back(between(a, b, row));
  return filled;
}

}  // namespace

std::uint64_t fill_gaps(Profile& strand, double largest_hole, const Spacing& spacing) {
  const Course course(strand.points, spacing);
  std::vector<ProfilePoint> points;
  points.reserve(strand.points.size());
  std::uint64_t filled = 0;
  for (std::size_t i = 0; i < strand.points.size(); ++i) {
    ProfilePoint point = strand.points[i];
    point.flags &= static_cast<std::uint8_t>(~kApart);
    if (i > 0) {
      const ProfilePoint& last = strand.points[i - 1];
      const bool gap = point.row - last.row > spacing.gap;
      if (!course.continues(i) || (gap && distance(last.at, point.at) > largest_hole))
        point.flags |= kApart;
      else if (gap)
        filled += fill(last, point, spacing.rows, points);
    }
    points.push_back(point);
  }
  strand.points = std::move(points);
  return filled;
}

}  // namespace vitrine::acquisition
