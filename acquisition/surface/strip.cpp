// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/surface/nearest_strand.h"

namespace vitrine::acquisition {
namespace {

// Cost of advancing by one point on one strand (line of measured points) without adding a triangle.
// This leaves a gap between two strands. In multiples of Spacing::bridge.
constexpr double kBreak = 10;

struct Side {
  std::size_t strand;
  const std::vector<ProfilePoint>& points;
  std::size_t first;  // index of the strand's first point in the cloud
  // For each point, the strand of the other step to which an edge may lead.
  std::vector<std::size_t> nearest;
  int rows;  // median number of rows between points (Spacing::rows)

  std::size_t size() const { return points.size(); }
  bool continues(std::size_t i) const { return i + 1 < size() && !(points[i + 1].flags & kApart); }
  // Returns the number of rows that point i represents.
  int reach(std::size_t i) const {
    int reach = rows;
    if (continues(i)) reach = std::max(reach, points[i + 1].row - points[i].row);
    if (i > 0 && continues(i - 1)) reach = std::max(reach, points[i].row - points[i - 1].row);
    return reach;
  }
  // Returns the rho at `row`, interpolated between point i and the strand's next point towards
  // `row`. Returns the rho of point i if the surface does not continue to that point.
  double depth_at(std::size_t i, int row) const {
    const ProfilePoint& at = points[i];
    std::size_t next = i;
    if (row > at.row && continues(i)) next = i + 1;
    if (row < at.row && i > 0 && continues(i - 1)) next = i - 1;
    if (next == i) return at.at.rho;
    const double t = static_cast<double>(row - at.row) / (points[next].row - at.row);
    return at.at.rho + std::min(t, 1.) * (points[next].at.rho - at.at.rho);
  }
};

// The candidate edges between two strands. They lead from each point of one strand to a range of
// points of the other at about the same rows. Consecutive ranges overlap, so a path down both
// strands always exists.
class Band {
 public:
  Band(const Side& a, const Side& b, int rows) {
    std::size_t low = 0, high = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      while (low + 1 < b.size() && b.points[low].row < a.points[i].row - rows)
        ++low;
      high = std::max(low, high);
      while (high + 1 < b.size() && b.points[high + 1].row <= a.points[i].row + rows)
        ++high;
      if (i > 0) end_.back() = std::max(end_.back(), low + 1);
      low_.push_back(i > 0 ? low : 0), end_.push_back(high + 1);
    }
    end_.back() = b.size();
    for (std::size_t i = 0, cells = 0; i < a.size(); cells += end_[i] - low_[i], ++i)
      first_.push_back(cells);
  }

  std::size_t size() const { return first_.back() + end_.back() - low_.back(); }
  std::size_t low(std::size_t i) const { return low_[i]; }
  std::size_t end(std::size_t i) const { return end_[i]; }
  bool has(std::size_t i, std::size_t j) const { return j >= low_[i] && j < end_[i]; }
  std::size_t cell(std::size_t i, std::size_t j) const { return first_[i] + j - low_[i]; }

 private:
  std::vector<std::size_t> low_, end_, first_;
};

// Returns the largest number of rows between two points that may be joined.
int rows_apart(const Side& a, const Side& b, const Spacing& spacing) {
  int rows = static_cast<int>(std::ceil(spacing.near / spacing.row_height));
  for (const Side* side : {&a, &b}) {
    for (std::size_t i = 0; i < side->size(); ++i)
      rows = std::max(rows, side->reach(i));
  }
  return rows;
}

class Strip {
 public:
  Strip(const Cloud& cloud, const Side& a, const Side& b, const Spacing& spacing)
      : cloud_(cloud),
        spacing_(spacing),
        a_(a),
        b_(b),
        band_(a, b, rows_apart(a, b, spacing)),
        edges_(band_.size()),
        ways_(band_.size()) {}

  void join(std::vector<Triangle>& faces) {
    find_ways();
    std::size_t i = a_.size() - 1, j = b_.size() - 1;
    while (i > 0 || j > 0) {
      const Way& way = ways_[band_.cell(i, j)];
      const std::uint32_t third = way.goes_down_a ? vertex_a(i) : vertex_b(j);
      way.goes_down_a ? --i : --j;
      if (way.joins) add(i, j, third, faces);
    }
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  // The cheapest path from the top of both strands to an edge between the strands.
  struct Way {
    double cost = kNever;
    bool goes_down_a = false, joins = false;  // describe the last step of the path
  };

  void find_ways() {
    for (std::size_t i = 0; i < a_.size(); ++i) {
      for (std::size_t j = band_.low(i); j < band_.end(i); ++j) {
        edges_[band_.cell(i, j)] = edge(i, j);
        Way& way = ways_[band_.cell(i, j)];
        if (i == 0 && j == 0) way.cost = 0;
        if (i > 0 && band_.has(i - 1, j)) offer(i, j, true, a_.continues(i - 1), way);
        if (j > band_.low(i)) offer(i, j, false, b_.continues(j - 1), way);
      }
    }
  }

  // Stores the path that ends with this step in `way`, unless `way` already holds a cheaper path. A
  // step without a triangle costs more than an edge of any length.
  void offer(std::size_t i, std::size_t j, bool goes_down_a, bool continues, Way& way) const {
    const std::size_t from = goes_down_a ? band_.cell(i - 1, j) : band_.cell(i, j - 1);
    const double length = edges_[band_.cell(i, j)];
    const bool joins = continues && edges_[from] < kNever && length < kNever;
    const double cost = ways_[from].cost + (joins ? length : kBreak * spacing_.bridge);
    if (cost < way.cost) way = {cost, goes_down_a, joins};
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
    const double distance = length_across(i, j);
    if (distance < spacing_.near) return true;
    if (std::abs(p.row - q.row) > std::max(a_.reach(i), b_.reach(j))) return false;
    const double in_depth = p.at.rho - q.at.rho, height = p.at.z - q.at.z;
    if (distance * distance - in_depth * in_depth - height * height >
        spacing_.bridge * spacing_.bridge)
      return false;
    // Compares the depths at the same row. In a sampled strand, the depth of a nearly flat surface
    // may change much between two points without a discontinuity.
    const double depth = std::min(std::abs(a_.depth_at(i, q.row) - q.at.rho),
                                  std::abs(b_.depth_at(j, p.row) - p.at.rho));
    return are_joined(depth, distance, spacing_);
  }

  double edge(std::size_t i, std::size_t j) const {
    return is_accepted(i, j) ? length_across(i, j) : kNever;
  }

  // Adds a face with its corners counter-clockwise, seen from the laser. Beyond the axis (rho < 0),
  // strand b lies on the other side of strand a, so the order is reversed.
  void add(std::size_t i, std::size_t j, std::uint32_t third, std::vector<Triangle>& faces) const {
    if (a_.points[i].at.rho < 0)
      faces.push_back({vertex_a(i), third, vertex_b(j)});
    else
      faces.push_back({vertex_a(i), vertex_b(j), third});
  }

  const Cloud& cloud_;
  const Spacing& spacing_;
  const Side &a_, &b_;
  const Band band_;
  std::vector<double> edges_;  // lengths of candidate edges; kNever if rejected
  std::vector<Way> ways_;      // the cheapest path to each edge
};

// Returns the strands of `step`, prepared for joining to the strands of the step `other`.
std::vector<Side> sides_of(const Cloud& cloud, std::size_t step, std::size_t other,
                           const Spacing& spacing) {
  std::vector<Side> sides;
  for (std::size_t k = cloud.steps[step]; k < cloud.steps[step + 1]; ++k)
    sides.push_back({.strand = k,
                     .points = cloud.strands[k].points,
                     .first = cloud.first[k],
                     .nearest = nearest_strands(cloud, k, other),
                     .rows = spacing.rows});
  return sides;
}

}  // namespace

void add_strips(const Cloud& cloud, std::size_t step, const Spacing& spacing,
                std::vector<Triangle>& faces) {
  const std::size_t next = cloud.after(step);
  const std::vector<Side> after = sides_of(cloud, next, step, spacing);
  for (const Side& a : sides_of(cloud, step, next, spacing)) {
    for (const Side& b : after) {
      if (a.size() > 0 && b.size() > 0) Strip(cloud, a, b, spacing).join(faces);
    }
  }
}

}  // namespace vitrine::acquisition
