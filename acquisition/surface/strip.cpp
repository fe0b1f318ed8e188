// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/strip.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vitrine {
namespace {

struct Side {
  const std::vector<ProfilePoint>& points;
  std::size_t first;  // of the cloud
  int rows;           // from point to point at least

  std::size_t size() const { return points.size(); }
  bool goes_on(std::size_t i) const { return i + 1 < size() && !(points[i + 1].flags & kApart); }
  // The rows that point i answers for.
  int reach(std::size_t i) const {
    int reach = rows;
    if (goes_on(i)) reach = std::max(reach, points[i + 1].row - points[i].row);
    if (i > 0 && goes_on(i - 1)) reach = std::max(reach, points[i].row - points[i - 1].row);
    return reach;
  }
};

class Strip {
 public:
  Strip(const Cloud& cloud, std::size_t profile, const Spacing& spacing)
      : cloud_(cloud),
        spacing_(spacing),
        a_{cloud.profiles[profile].points, cloud.first[profile], spacing.rows},
        b_{cloud.profiles[cloud.after(profile)].points, cloud.first[cloud.after(profile)],
           spacing.rows} {}

  void walk(std::vector<Triangle>& faces) {
    std::size_t i = 0, j = 0;
    while (i < a_.size() && j < b_.size()) {
      const bool here = is_accepted(i, j);
      const double down_a = here && a_.goes_on(i) ? edge(i + 1, j) : kNever;
      const double down_b = here && b_.goes_on(j) ? edge(i, j + 1) : kNever;
      if (down_a < kNever || down_b < kNever) {
        const bool left = down_a <= down_b;
        add(i, j, left ? vertex_a(i + 1) : vertex_b(j + 1), faces);
        left ? ++i : ++j;
      } else {
        // Each of the two points has all it can have: the upper one goes.
        next_row(a_, i) < next_row(b_, j) ? ++i : ++j;
      }
    }
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  static int next_row(const Side& side, std::size_t i) {
    return i + 1 < side.size() ? side.points[i + 1].row : std::numeric_limits<int>::max();
  }
  std::uint32_t vertex_a(std::size_t i) const { return static_cast<std::uint32_t>(a_.first + i); }
  std::uint32_t vertex_b(std::size_t j) const { return static_cast<std::uint32_t>(b_.first + j); }

  double length_across(std::size_t i, std::size_t j) const {
    return length(cloud_.positions[vertex_a(i)] - cloud_.positions[vertex_b(j)]);
  }

  bool is_accepted(std::size_t i, std::size_t j) const {
    const ProfilePoint &p = a_.points[i], &q = b_.points[j];
    if ((p.at.rho < 0) != (q.at.rho < 0)) return false;
    if (std::abs(p.row - q.row) > std::max(a_.reach(i), b_.reach(j))) return false;
    const double distance = length_across(i, j), depth = p.at.rho - q.at.rho,
                 height = p.at.z - q.at.z;
    if (distance * distance - depth * depth - height * height > spacing_.bridge * spacing_.bridge)
      return false;
    return are_joined(p.at.rho, q.at.rho, distance, spacing_);
  }

  double edge(std::size_t i, std::size_t j) const {
    return is_accepted(i, j) ? length_across(i, j) : kNever;
  }

  // Rows go down and the object has been turned back further in the next profile, so that this
  // order is counter-clockwise from the laser's side; beyond the axis the turn goes the other way.
  void add(std::size_t i, std::size_t j, std::uint32_t third, std::vector<Triangle>& faces) const {
    if (a_.points[i].at.rho < 0)
      faces.push_back({vertex_a(i), third, vertex_b(j)});
    else
      faces.push_back({vertex_a(i), vertex_b(j), third});
  }

  const Cloud& cloud_;
  const Spacing& spacing_;
  Side a_, b_;
};

}  // namespace

void add_strip(const Cloud& cloud, std::size_t profile, const Spacing& spacing,
               std::vector<Triangle>& faces) {
  Strip(cloud, profile, spacing).walk(faces);
}

}  // namespace vitrine
