// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/steps.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "acquisition/surface/nearest_strand.h"

namespace vitrine::acquisition {
namespace {

ProfilePoint point(int row, double rho) {
  return {{rho, 0, -.1 * row}, row};
}

std::vector<double> rhos(const Profile& strand) {
  std::vector<double> rhos;
  for (const ProfilePoint& p : strand.points)
    rhos.push_back(p.at.rho);
  return rhos;
}

TEST(Strands, OfOnePointARowAreOne) {
  const Profile profile{30, {point(2, 10), point(3, 50), point(9, -10)}};
  const auto strands = strands_of(profile);
  ASSERT_EQ(strands.size(), 1);
  EXPECT_EQ(strands[0].theta, 30);
  EXPECT_EQ(rhos(strands[0]), rhos(profile));
  EXPECT_EQ(strands_of({}).size(), 1);
}

// The two points in a row may be in either order.
TEST(Strands, FollowTheSurface) {
  std::mt19937 random(1);
  Profile profile{30, {}};
  for (int row = 0; row < 50; ++row) {
    profile.points.insert(profile.points.end(), {point(row, 20 + .1 * row), point(row, 12)});
    if (random() % 2) std::iter_swap(profile.points.end() - 1, profile.points.end() - 2);
  }
  auto strands = strands_of(profile);
  ASSERT_EQ(strands.size(), 2);
  if (rhos(strands[0])[0] == 12) std::swap(strands[0], strands[1]);
  EXPECT_THAT(rhos(strands[1]), testing::Each(12));
  for (const ProfilePoint& p : strands[0].points)
    EXPECT_EQ(p.at.rho, 20 + .1 * p.row);
  EXPECT_EQ(strands[1].theta, 30);
}

TEST(Strands, ASurfaceThatIsAloneAgainStaysInItsStrand) {
  Profile profile{0, {point(0, 20), point(1, 20), point(1, 12), point(2, 20), point(2, 12)}};
  profile.points.insert(profile.points.end(), {point(3, 12), point(4, 12), point(5, 20)});
  const auto strands = strands_of(profile);
  ASSERT_EQ(strands.size(), 2);
  EXPECT_THAT(rhos(strands[0]), testing::ElementsAre(20, 20, 20, 20));
  EXPECT_THAT(rhos(strands[1]), testing::ElementsAre(12, 12, 12, 12));
}

// If the nearest strand has no point in the row of the given point, its position there is
// interpolated. There is no such position if the surface ends between two points of the strand.
TEST(NearestStrand, IsNearAtThePointsRow) {
  Profile sparse{0, {point(0, 20), point(40, 20)}}, dense{0, {}};
  for (int row = 0; row <= 40; ++row)
    dense.points.push_back(point(row, 17));
  const Profile next{.01, {point(20, 18.8)}};
  EXPECT_THAT(nearest_strands(Cloud({sparse, dense, next}), 2, 0), testing::ElementsAre(0));
  sparse.points[1].flags = kApart;
  EXPECT_THAT(nearest_strands(Cloud({sparse, dense, next}), 2, 0), testing::ElementsAre(1));
}

}  // namespace
}  // namespace vitrine::acquisition
