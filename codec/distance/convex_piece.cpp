// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/convex_piece.h"

#include <algorithm>
#include <cmath>

namespace vitrine::inline codec {

Vec3 ConvexPiece::centre() const {
  Vec3 sum;
  for (const Vec3& p : corners())
    sum += p;
  return sum * (1.0 / static_cast<double>(corners_.size()));
}

double ConvexPiece::radius(const Vec3& centre) const {
  double squared = 0;
  for (const Vec3& p : corners())
    squared = std::max(squared, dot(p - centre, p - centre));
  return std::sqrt(squared);
}

ConvexPiece::Parts ConvexPiece::cut(const Vec3& p, const Vec3& normal, double slack) const {
  Parts parts;
  double most = 0, least = 0;
  Vec3 a = corners_.back();
  double side_a = dot(a - p, normal);
  for (const Vec3& b : corners()) {
    const double side_b = dot(b - p, normal);
    if ((side_a < 0 && side_b > 0) || (side_a > 0 && side_b < 0)) {
      const Vec3 on_plane = a + (b - a) * (side_a / (side_a - side_b));
      parts.front.add(on_plane);
      parts.back.add(on_plane);
    }
    if (side_b >= 0) parts.front.add(b);
    if (side_b <= 0) parts.back.add(b);
    most = std::max(most, side_b), least = std::min(least, side_b);
    a = b, side_a = side_b;
  }
  if (least >= -slack) return {*this, {}};
  if (most <= slack) return {{}, *this};
  return parts;
}

ConvexPiece::Parts ConvexPiece::halves() const {
  if (is_full()) {
    Parts parts;
    const std::size_t half = corners_.size() / 2;
    parts.front.corners_.assign(corners_.begin(), corners_.begin() + half + 1);
    parts.back.corners_.assign(corners_.begin() + half, corners_.end());
    parts.back.add(corners_[0]);
    return parts;
  }
  const Vec3 middle = centre();
  Vec3 farthest = corners_[0] - middle;
  for (const Vec3& p : corners()) {
    if (dot(p - middle, p - middle) > dot(farthest, farthest)) farthest = p - middle;
  }
  return cut(middle, farthest, 0);
}

}  // namespace vitrine::inline codec
