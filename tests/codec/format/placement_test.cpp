// SPDX-License-Identifier: Apache-2.0
#include "codec/format/placement.h"

#include <gtest/gtest.h>

#include "codec/coding/mesh_state.h"
#include "support/random_mesh.h"

namespace vitrine {
namespace {

using test::Dice;

Vec3i random_vector(Dice& dice, std::int32_t bound) {
  if (dice.one_in(4)) bound = 2;
  return {dice.between(-bound, bound), dice.between(-bound, bound), dice.between(-bound, bound)};
}

TEST(Placement, UnmergeTakesBackMergeForAnyTerm) {
  Dice dice(1);
  for (int i = 0; i < 200'000; ++i) {
    const Vec3i v1 = random_vector(dice, kCoordinateBound);
    const Vec3i v2 = random_vector(dice, kCoordinateBound);
    const Vec3i r = random_vector(dice, 4 * kCoordinateBound);
    const SplitPair back = unmerge(merge(v1, v2, r), v1 - v2, r);
    ASSERT_EQ(back.v1, v1);
    ASSERT_EQ(back.v2, v2);
  }
}

TEST(Placement, UnmergeTakesBackMergeAtTheExtremes) {
  const std::int32_t b = kCoordinateBound;
  const std::array values = {-b, -b + 1, -1, 0, 1, b - 1, b};
  for (const std::int32_t x : values) {
    for (const std::int32_t y : values) {
      for (const std::int32_t r : {-4 * b, -1, 0, 1, 2, 4 * b}) {
        const Vec3i v1 = {x, y, x}, v2 = {y, x, x}, term = {r, r, -r};
        const SplitPair back = unmerge(merge(v1, v2, term), v1 - v2, term);
        ASSERT_EQ(back.v1, v1);
        ASSERT_EQ(back.v2, v2);
      }
    }
  }
}

TEST(Placement, MidpointIsBetweenItsVertices) {
  Dice dice(2);
  for (int i = 0; i < 10'000; ++i) {
    const Vec3i v1 = random_vector(dice, 70'000), v2 = random_vector(dice, 70'000);
    const Vec3i m = merge(v1, v2, midpoint_term(dice.between(0, 1)));
    ASSERT_GE(m.x, std::min(v1.x, v2.x));
    ASSERT_LE(m.x, std::max(v1.x, v2.x));
  }
}

TEST(Placement, LevelsAlternateTheirParityFromTheFinest) {
  EXPECT_EQ(level_parity(9, 9), 0);
  EXPECT_EQ(level_parity(8, 9), 1);
  EXPECT_EQ(level_parity(1, 9), 0);
}

// Tests r = 2 (sum(opposite) / 4m - sum(others) / 4n), rounded half up. m and n are the numbers of
// points in `opposite` and `others`.
TEST(Placement, PyramidTermRoundsHalfUpAndAddsTheParity) {
  const std::vector<Vec3i> opposite = {{3, -3, 10}, {4, -4, 10}}, others = {{0, 0, 4}};
  // The values before rounding are 1.75, -1.75 and 3.
  EXPECT_EQ(pyramid_term(opposite, others, 0), (Vec3i{2, -2, 3}));
  EXPECT_EQ(pyramid_term(opposite, others, 1), (Vec3i{3, -1, 4}));
  const std::vector<Vec3i> one = {{1, -1, 3}};
  EXPECT_EQ(pyramid_term(one, others, 0), (Vec3i{1, 0, 0}));  // before rounding: 0.5, -0.5, -0.5
  EXPECT_EQ(pyramid_term({}, others, 1), (Vec3i{1, 1, 1}));
  EXPECT_EQ(pyramid_term(one, {}, 1), (Vec3i{1, 1, 1}));
}

}  // namespace
}  // namespace vitrine
