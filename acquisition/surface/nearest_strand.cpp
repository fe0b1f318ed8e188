// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/nearest_strand.h"

#include <algorithm>
#include <limits>

namespace vitrine::acquisition {
namespace {

// Computes distances from one strand to points, which must come in ascending order of rows.
class Distance {
 public:
  Distance(const Cloud& cloud, std::size_t strand)
      : points_(cloud.strands[strand].points), at_(cloud.positions.data() + cloud.first[strand]) {}

  // Returns the squared distance from `p` to the strand's position at `row`. Between two joined
  // points, that position is interpolated.
  double to(const Vec3& p, int row) {
    while (below_ < points_.size() && points_[below_].row < row)
      ++below_;
    double least = std::numeric_limits<double>::infinity();
    const auto offer = [&](const Vec3& q) { least = std::min(least, dot(q - p, q - p)); };
    if (below_ < points_.size()) offer(at_[below_]);
    if (below_ > 0) offer(at_[below_ - 1]);
    if (below_ > 0 && below_ < points_.size() && !(points_[below_].flags & kApart)) {
      const int from = points_[below_ - 1].row;
      const double t = static_cast<double>(row - from) / (points_[below_].row - from);
      offer(at_[below_ - 1] + (at_[below_] - at_[below_ - 1]) * t);
    }
    return least;
  }

 private:
  const std::vector<ProfilePoint>& points_;
  const Vec3* at_;
  std::size_t below_ = 0;  // index of the first point at or below the current row
};

}  // namespace

std::vector<std::size_t> nearest_strands(const Cloud& cloud, std::size_t strand, std::size_t step) {
  const std::vector<ProfilePoint>& points = cloud.strands[strand].points;
  std::vector<std::size_t> nearest(points.size(), cloud.steps[step]);
  if (cloud.strands_of(step) == 1) return nearest;
  std::vector<double> least(points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t other = cloud.steps[step]; other < cloud.steps[step + 1]; ++other) {
    Distance distance(cloud, other);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double d = distance.to(cloud.positions[cloud.first[strand] + i], points[i].row);
      if (d < least[i]) least[i] = d, nearest[i] = other;
    }
  }
  return nearest;
}

}  // namespace vitrine::acquisition
