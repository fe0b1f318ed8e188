// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/convex_piece.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace vitrine::test {
namespace {

using Random = std::mt19937_64;

Vec3 near_by(Random& random, double offset) {
  std::uniform_real_distribution<double> unit(-1, 1);
  return {offset + unit(random), offset + unit(random), offset + unit(random)};
}

// Returns a random point on the edge that starts at corner number `corner`.
Vec3 on_edge(const ConvexPiece& piece, std::size_t corner, Random& random) {
  const auto corners = piece.corners();
  const double share = std::uniform_real_distribution<double>(0, 1)(random);
  const Vec3 &a = corners[corner % corners.size()], &b = corners[(corner + 1) % corners.size()];
  return a + (b - a) * share;
}

// Cuts pieces along lines through two points on their edges. The pieces lie far from the origin,
// where rounding puts corners on alternating sides of the cut. A cut may therefore add more corners
// than in exact arithmetic.
TEST(ConvexPiece, HoldsTheCornersThatRoundingAddsToACut) {
  Random random(1);
  std::size_t most = 0;
  for (int run = 0; run < 20'000; ++run) {
    const TrianglePoints triangle{near_by(random, 1e6), near_by(random, 1e6), near_by(random, 1e6)};
    const Vec3 normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    ConvexPiece piece(triangle);
    for (int k = 0; k < 16 && !piece.is_full(); ++k) {
      const std::size_t corner = random() % piece.corners().size();
      const Vec3 from = on_edge(piece, corner + random() % 3, random);
      const Vec3 across = cross(normal, on_edge(piece, corner + random() % 3, random) - from);
      const double size = length(across);
      if (!(size > 0)) continue;
      const auto [front, back] = piece.cut(from, across * (1 / size), 0);
      piece = front.corners().size() > back.corners().size() ? front : back;
      most = std::max(most, piece.corners().size());
    }
  }
  EXPECT_GT(most, 13u);  // exact arithmetic gives at most 13 corners
}

TEST(ConvexPiece, HalvesOfOneThatIsTooSmallToHalveAreItselfAndNothing) {
  const double far = 0x1p50, step = 0.25;
  const ConvexPiece piece({{far, far, far}, {far + step, far, far}, {far, far + step, far}});
  const auto [front, back] = piece.halves();
  EXPECT_NE(front.empty(), back.empty());
}

}  // namespace
}  // namespace vitrine::test
