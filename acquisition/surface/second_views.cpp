// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/steps.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vitrine::acquisition {
namespace {

using Cell = std::array<std::int32_t, 3>;

struct Placed {
  Cell cell;
  std::size_t point;
  auto operator<=>(const Placed&) const = default;
};

Cell cell_of(const Vec3& p, double size) {
  const auto index = [size](double x) { return static_cast<std::int32_t>(std::floor(x / size)); };
  return {index(p.x), index(p.y), index(p.z)};
}

class Near {
 public:
  Near(const Cloud& cloud, double reach, const std::vector<std::size_t>& points)
      : cloud_(cloud), reach_(reach) {
    for (const std::size_t i : points)
      placed_.push_back({cell_of(cloud.positions[i], reach), i});
    std::ranges::sort(placed_);
  }

  bool has(const Vec3& p) const {
    const Cell middle = cell_of(p, reach_);
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        if (has(p, {middle[0] + x, middle[1] + y, middle[2] - 1})) return true;
      }
    }
    return false;
  }

 private:
  // Returns whether a point lies within `reach_` of `p`, in one of three cells that are adjacent in
  // z. These cells are consecutive in memory.
  bool has(const Vec3& p, const Cell& low) const {
    const Placed from{low, 0};
    const Cell high = {low[0], low[1], low[2] + 2};
    for (auto at = std::ranges::lower_bound(placed_, from); at != placed_.end() && at->cell <= high;
         ++at) {
      const Vec3 d = cloud_.positions[at->point] - p;
      if (dot(d, d) <= reach_ * reach_) return true;
    }
    return false;
  }

  const Cloud& cloud_;
  double reach_;
  std::vector<Placed> placed_;
};

}  // namespace

std::vector<bool> first_views(const Cloud& cloud, double reach) {
  std::vector<std::size_t> before, beyond;
  std::size_t i = 0;
  for (const Profile& strand : cloud.strands) {
    for (const ProfilePoint& point : strand.points)
      (point.at.rho < 0 ? beyond : before).push_back(i++);
  }
  std::vector<bool> kept(cloud.size(), true);
  if (beyond.empty()) return kept;
  const Near near(cloud, reach, before);
  for (const std::size_t k : beyond)
    kept[k] = !near.has(cloud.positions[k]);
  return kept;
}

}  // namespace vitrine::acquisition
