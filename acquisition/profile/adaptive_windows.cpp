// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/adaptive_windows.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};
// Merges that cost less than this, in multiples of the noise's variance, count as free. If two
// windows lie on a common line, the cost comes from noise alone. That cost has a chi-square
// distribution with two degrees of freedom, of which 95 % lies below this value.
constexpr double kInsignificant = 6;

struct Join {
  double cost;         // squared deviation that the merge adds beyond the noise, in mm²
  std::size_t length;  // number of points in both windows
  std::size_t left;    // index of the left window's first point
  // The windows' point counts when the merge was proposed. The merge is void if a count has changed
  // since then.
  std::size_t right_count, left_count;

  bool operator>(const Join& o) const {
    return std::tie(cost, length, left) > std::tie(o.cost, o.length, o.left);
  }
};

class Windows {
 public:
  Windows(std::span<const ProfilePoint> points, const WindowLimits& limits)
      : points_(points), limits_(limits), count_(points.size()), windows_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      windows_[i] = {i, 1, {}};
      windows_[i].line.add(points[i].at.rho - points[0].at.rho, points[i].at.z - points[0].at.z);
    }
    before_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      before_[i] = i == 0 ? kNone : i - 1;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      offer(i);
  }

  std::vector<Window> take() {
    while (count_ > limits_.windows && !joins_.empty()) {
      const Join join = joins_.top();
      joins_.pop();
      if (is_current(join)) merge(join.left);
    }
    std::vector<Window> windows;
    for (std::size_t i = 0; i < windows_.size(); i += windows_[i].count)
      windows.push_back(windows_[i]);
    return windows;
  }

 private:
  std::size_t after(std::size_t i) const { return i + windows_[i].count; }

  bool is_current(const Join& join) const {
    return alive(join.left) && windows_[join.left].count == join.left_count &&
           windows_[join.left + join.left_count].count == join.right_count;
  }
  bool alive(std::size_t i) const { return windows_[i].count > 0; }

  void offer(std::size_t left) {
    const std::size_t right = after(left);
    if (right >= points_.size() || (points_[right].flags & kApart)) return;
    const Window &a = windows_[left], &b = windows_[right];
    if (a.count + b.count > limits_.longest) return;
    const double added =
        (a.line + b.line).squares_across() - a.line.squares_across() - b.line.squares_across();
    const double noise = kInsignificant * limits_.noise * limits_.noise;
    joins_.push({.cost = std::max(0., added - noise),
                 .length = a.count + b.count,
                 .left = left,
                 .right_count = b.count,
                 .left_count = a.count});
  }

  void merge(std::size_t left) {
    const std::size_t right = after(left);
    windows_[left].line = windows_[left].line + windows_[right].line;
    windows_[left].count += windows_[right].count;
    windows_[right].count = 0;
    if (after(left) < points_.size()) before_[after(left)] = left;
    --count_;
    offer(left);
    if (before_[left] != kNone) offer(before_[left]);
  }

  std::span<const ProfilePoint> points_;
  WindowLimits limits_;
  std::size_t count_;
  // Each window is stored at the index of its first point. A window that was merged into another
  // has count 0.
  std::vector<Window> windows_;
  std::vector<std::size_t> before_;  // index of the preceding window's first point
  std::priority_queue<Join, std::vector<Join>, std::greater<>> joins_;
};

}  // namespace

std::vector<Window> adaptive_windows(std::span<const ProfilePoint> points,
                                     const WindowLimits& limits) {
  if (points.empty()) return {};
  return Windows(points, limits).take();
}

}  // namespace vitrine::acquisition
