// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/triangulate.h"

#include <bit>
#include <numeric>
#include <utility>

namespace vitrine::inline codec {
namespace {

// The corners of a polygon that have not been clipped, as a ring.
class CornerRing {
 public:
  explicit CornerRing(std::size_t size) : before_(size), after_(size) {
    std::iota(before_.begin() + 1, before_.end(), 0);
    std::iota(after_.begin(), after_.end() - 1, 1);
    before_.front() = static_cast<std::uint32_t>(size - 1);
  }

  std::uint32_t before(std::uint32_t corner) const { return before_[corner]; }
  std::uint32_t after(std::uint32_t corner) const { return after_[corner]; }
  void remove(std::uint32_t corner) {
    after_[before_[corner]] = after_[corner];
    before_[after_[corner]] = before_[corner];
  }

 private:
  std::vector<std::uint32_t> before_, after_;
};

bool is_convex_at(std::span<const FlatCorner> polygon, const CornerRing& ring,
                  std::uint32_t corner) {
  return signed_area(polygon[ring.before(corner)], polygon[corner], polygon[ring.after(corner)]) >
         0;
}

// Returns the corners that are not convex. Only these need a test: if the triangle of three corners
// contains any other corner, it also contains one that is not convex.
std::vector<std::uint32_t> corners_not_convex(std::span<const FlatCorner> polygon,
                                              const CornerRing& ring) {
  std::vector<std::uint32_t> corners;
  for (std::uint32_t corner = 0; corner < polygon.size(); ++corner) {
    if (!is_convex_at(polygon, ring, corner)) corners.push_back(corner);
  }
  return corners;
}

class EarClipper {
 public:
  EarClipper(std::span<const FlatCorner> polygon, std::vector<Triangle>& triangles)
      : polygon_(polygon),
        triangles_(triangles),
        left_(polygon.size()),
        ring_(polygon.size()),
        tree_(polygon, corners_not_convex(polygon, ring_)),
        waits_(polygon.size(), true),
        next_pass_(polygon.size()) {
    std::iota(next_pass_.begin(), next_pass_.end(), 0);
  }

  std::uint64_t clip_all() {
    std::uint32_t rest = 0;  // a corner that has not been clipped
    while (left_ > 3) {
      const std::vector<std::uint32_t> pass = std::exchange(next_pass_, {});
      for (const std::uint32_t corner : pass)
        waits_[corner] = false;
      for (const std::uint32_t corner : pass) {
        if (left_ > 3 && !waits_[corner] && is_ear(corner)) rest = clip(corner);
      }
      if (next_pass_.empty() && left_ > 3) rest = clip(rest);
    }
    triangles_.push_back({ring_.before(rest), rest, ring_.after(rest)});
    return steps();
  }

 private:
  std::uint64_t steps() const { return tests_ + tree_.visited(); }

  bool is_ear(std::uint32_t corner) {
    ++tests_;
    if (!is_convex_at(polygon_, ring_, corner)) return false;
    if (steps() > kMostSteps * polygon_.size() * std::bit_width(polygon_.size())) return true;
    return !tree_.has_corner_in(polygon_[ring_.before(corner)], polygon_[corner],
                                polygon_[ring_.after(corner)]);
  }

  // Cuts a corner off. Returns the next corner.
  std::uint32_t clip(std::uint32_t corner) {
    const std::uint32_t before = ring_.before(corner), after = ring_.after(corner);
    triangles_.push_back({before, corner, after});
    ring_.remove(corner);
    --left_;
    if (tree_.has(corner)) tree_.remove(corner);
    for (const std::uint32_t neighbour : {before, after}) {
      if (tree_.has(neighbour) && is_convex_at(polygon_, ring_, neighbour)) tree_.remove(neighbour);
      if (!waits_[neighbour]) next_pass_.push_back(neighbour);
      waits_[neighbour] = true;
    }
    return after;
  }

  // limit for the number of steps, in multiples of n log2 n
  static constexpr std::uint64_t kMostSteps = 64;

  std::span<const FlatCorner> polygon_;
  std::vector<Triangle>& triangles_;
  std::size_t left_;  // number of corners that have not been clipped
  CornerRing ring_;
  CornerTree tree_;          // the corners that are not convex
  std::vector<bool> waits_;  // whether a corner is in next_pass_
  // Corners to test in the next pass: clipping an ear can turn only its two neighbours into ears.
  std::vector<std::uint32_t> next_pass_;
  std::uint64_t tests_ = 0;
};

}  // namespace

std::uint64_t clip_ears(std::span<const FlatCorner> polygon, std::vector<Triangle>& triangles) {
  return EarClipper(polygon, triangles).clip_all();
}

}  // namespace vitrine::inline codec
