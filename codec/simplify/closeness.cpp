// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/closeness.h"

#include <algorithm>
#include <array>

#include "codec/mesh/closest_point.h"

namespace vitrine {
namespace {

// The faces around an edge, before or after it has collapsed.
class Patch {
 public:
  Patch(const Surface& surface, double reach) : surface_(surface), squared_(reach * reach) {}

  // The faces of a star whose centre is at `centre`, but for those at `without`. Two at most.
  void add(const Star& star, const Vec3& centre, VertexId without) {
    centre_[size_ > 0] = centre;
    VertexId a = star.vertex[star.valence - 1];
    for (VertexId b : star.neighbours()) {
      const bool real = !is_virtual(a) && !is_virtual(b);
      if (real && a != without && b != without) side_[size_++] = {a, b};
      a = b;
    }
    if (first_ == 0) first_ = size_;
  }

  Corners face(std::uint32_t i) const {
    const auto [a, b] = side_[i];
    return {centre_[i >= first_], surface_.point(a), surface_.point(b)};
  }

  // Points come in the order of the faces, so that the search goes on where the last one ended.
  bool is_near(const Vec3& p) {
    for (std::uint32_t i = 0; i < size_; ++i) {
      if (squared_distance(face(last_), p) <= squared_) return true;
      last_ = last_ + 1 < size_ ? last_ + 1 : 0;
    }
    return false;
  }

  // The middles of the edges of a star with its centre at `centre`, but for that to `without`.
  bool has_near(const Star& star, const Vec3& centre, VertexId without) {
    return std::ranges::all_of(star.neighbours(), [&](VertexId v) {
      return v == without || is_virtual(v) || is_near((centre + surface_.point(v)) * 0.5);
    });
  }

  // The middles of the faces of another patch.
  bool has_near(const Patch& other) {
    for (std::uint32_t i = 0; i < other.size_; ++i) {
      const Corners f = other.face(i);
      if (!is_near((f.a + f.b + f.c) * (1.0 / 3))) return false;
    }
    return true;
  }

 private:
  struct Side {
    VertexId a, b;
  };

  const Surface& surface_;
  double squared_;
  std::array<Vec3, 2> centre_;
  std::array<Side, 2 * Star::kCapacity> side_;     // across from the centre
  std::uint32_t size_ = 0, first_ = 0, last_ = 0;  // first_: of the first centre
};

}  // namespace

bool keeps_near(const Surface& surface, const EdgeStar& edge, const Vec3i& target, double reach) {
  const Vec3 p1 = surface.point(edge.v1), p2 = surface.point(edge.v2), to = surface.middle(target);
  Patch after(surface, reach);
  after.add(edge.star1, to, edge.v2);
  after.add(edge.star2, to, edge.v1);
  if (!after.is_near(p1) || !after.is_near(p2)) return false;
  Patch before(surface, reach);
  before.add(edge.star1, p1, edge.v1);
  before.add(edge.star2, p2, edge.v2);
  // Edges that go and come in pairs are half as far apart as their ends.
  const auto move = [&](const Star& star, VertexId v, VertexId other, const Vec3& from) {
    return length(to - from) <= 2 * reach ||
           (after.has_near(star, from, v) && before.has_near(star, to, other));
  };
  return move(edge.star1, edge.v1, edge.v2, p1) && move(edge.star2, edge.v2, edge.v1, p2) &&
         before.has_near(after);
}

}  // namespace vitrine
