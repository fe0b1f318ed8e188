// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/strip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/surface/nearest_strand.h"

namespace vitrine {
namespace {

struct Side {
  std::size_t strand;
  const std::vector<ProfilePoint>& points;
  std::size_t first;  // of the cloud
  std::vector<std::size_t>
      nearest;  // the strand of the other step that each point may be joined to
  int rows;     // from point to point at least

  std::size_t size() const { return points.size(); }
  bool goes_on(std::size_t i) const { return i + 1 < size() && !(points[i + 1].flags & kApart); }
  // The rows that point i answers for.
  int reach(std::size_t i) const {
    int reach = rows;
    if (goes_on(i)) reach = std::max(reach, points[i + 1].row - points[i].row);
    if (i > 0 && goes_on(i - 1)) reach = std::max(reach, points[i].row - points[i - 1].row);
    return reach;
  }
  // The rho that the strand has at `row` if it goes there from point i, otherwise that of point i.
  double depth_at(std::size_t i, int row) const {
    const ProfilePoint& at = points[i];
    std::size_t next = i;
    if (row > at.row && goes_on(i)) next = i + 1;
    if (row < at.row && i > 0 && goes_on(i - 1)) next = i - 1;
    if (next == i) return at.at.rho;
    const double t = static_cast<double>(row - at.row) / (points[next].row - at.row);
    return at.at.rho + std::min(t, 1.) * (points[next].at.rho - at.at.rho);
  }
};

class Strip {
 public:
  Strip(const Cloud& cloud, const Side& a, const Side& b, const Spacing& spacing)
      : cloud_(cloud), spacing_(spacing), a_(a), b_(b) {}

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
    if (a_.nearest[i] != b_.strand || b_.nearest[j] != a_.strand) return false;
    if ((p.at.rho < 0) != (q.at.rho < 0)) return false;
    if (std::abs(p.row - q.row) > std::max(a_.reach(i), b_.reach(j))) return false;
    const double distance = length_across(i, j), in_depth = p.at.rho - q.at.rho,
                 height = p.at.z - q.at.z;
    if (distance * distance - in_depth * in_depth - height * height >
        spacing_.bridge * spacing_.bridge)
      return false;
    // Depths are compared at the same row: between the rows of a sampled strand a surface that is
    // nearly flat goes far in depth without a step.
    const double depth = std::min(std::abs(a_.depth_at(i, q.row) - q.at.rho),
                                  std::abs(b_.depth_at(j, p.row) - p.at.rho));
    return are_joined(depth, distance, spacing_);
  }

  double edge(std::size_t i, std::size_t j) const {
    return is_accepted(i, j) ? length_across(i, j) : kNever;
  }

  // Rows go down and the object has been turned back further in the next step, so that this
  // order is counter-clockwise from the laser's side; beyond the axis the turn goes the other way.
  void add(std::size_t i, std::size_t j, std::uint32_t third, std::vector<Triangle>& faces) const {
    if (a_.points[i].at.rho < 0)
      faces.push_back({vertex_a(i), third, vertex_b(j)});
    else
      faces.push_back({vertex_a(i), vertex_b(j), third});
  }

  const Cloud& cloud_;
  const Spacing& spacing_;
  const Side &a_, &b_;
};

// The strands of a step, to be joined to those of `other`.
std::vector<Side> sides_of(const Cloud& cloud, std::size_t step, std::size_t other,
                           const Spacing& spacing) {
  std::vector<Side> sides;
  for (std::size_t k = cloud.steps[step]; k < cloud.steps[step + 1]; ++k)
    sides.push_back({k, cloud.strands[k].points, cloud.first[k], nearest_strands(cloud, k, other),
                     spacing.rows});
  return sides;
}

}  // namespace

void add_strips(const Cloud& cloud, std::size_t step, const Spacing& spacing,
                std::vector<Triangle>& faces) {
  const std::size_t next = cloud.after(step);
  const std::vector<Side> after = sides_of(cloud, next, step, spacing);
  for (const Side& a : sides_of(cloud, step, next, spacing)) {
    for (const Side& b : after)
      Strip(cloud, a, b, spacing).walk(faces);
  }
}

}  // namespace vitrine
