// SPDX-License-Identifier: Apache-2.0
// A convex piece of a triangle, and its cuts.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <span>

#include "codec/core/vec.h"
#include "codec/mesh/closest_point.h"

namespace vitrine {

class ConvexPiece {
 public:
  // A cut adds a corner. Where rounding has put corners on both sides of it in turn, it adds half
  // as many as there are.
  static constexpr std::size_t kCapacity = 18;

  ConvexPiece() = default;
  explicit ConvexPiece(const Corners& t) : corners_{t.a, t.b, t.c} {}

  std::span<const Vec3> corners() const { return corners_; }
  bool empty() const { return corners_.empty(); }
  bool full() const { return corners_.size() + 6 > kCapacity; }  // has no room for a cut

  Vec3 centre() const;                      // mean of the corners
  double radius(const Vec3& centre) const;  // farthest corner

  struct Cut;
  // Parts on either side of the plane through `p`; `front` is where the unit `normal` points. A
  // part that reaches no farther than `slack` from the plane is empty, and the other one is all of
  // the piece. The piece is not full.
  Cut cut(const Vec3& p, const Vec3& normal, double slack) const;
  // Two halves: across the longest extent, or along a diagonal where the piece is full.
  Cut halves() const;

 private:
  void add(const Vec3& p) { corners_.push_back(p); }

  boost::container::static_vector<Vec3, kCapacity> corners_;
};

struct ConvexPiece::Cut {
  ConvexPiece front, back;
};

}  // namespace vitrine
