// SPDX-License-Identifier: Apache-2.0
// A convex piece of a triangle. Planes can cut it into smaller pieces.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <span>

#include "codec/core/vec.h"
#include "codec/mesh/closest_point.h"

namespace vitrine::inline codec {

class ConvexPiece {
 public:
  // Maximum number of corners. A cut normally adds one corner. If rounding puts the corners on
  // alternating sides of the plane, a cut adds half as many corners as there are.
  static constexpr std::size_t kCapacity = 18;

  ConvexPiece() = default;
  explicit ConvexPiece(const TrianglePoints& t) : corners_{t.a, t.b, t.c} {}

  std::span<const Vec3> corners() const { return corners_; }
  bool empty() const { return corners_.empty(); }
  // Whether there is no room for the corners that another cut may add.
  bool is_full() const { return corners_.size() + 6 > kCapacity; }

  Vec3 centre() const;                      // mean of the corners
  double radius(const Vec3& centre) const;  // distance from `centre` to the farthest corner

  struct Parts;
  // Cuts the piece along the plane through `p` with the unit vector `normal`. The part called
  // `front` is on the side to which `normal` points. If the piece extends at most `slack` beyond
  // the plane on one side, that side's part is empty and the other part is the whole piece. The
  // piece must not be full.
  Parts cut(const Vec3& p, const Vec3& normal, double slack) const;
  // Cuts the piece through its centre, perpendicular to the direction of its farthest corner. A
  // full piece is cut along a diagonal instead, because this adds no corner.
  Parts halves() const;

 private:
  void add(const Vec3& p) { corners_.push_back(p); }

  boost::container::static_vector<Vec3, kCapacity> corners_;
};

struct ConvexPiece::Parts {
  ConvexPiece front, back;
};

}  // namespace vitrine::inline codec
