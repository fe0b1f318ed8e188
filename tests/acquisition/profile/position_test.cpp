// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "acquisition/profile/profile.h"

namespace vitrine::acquisition {
namespace {

void expect_at(const Vec3& p, const Vec3& q) {
  EXPECT_NEAR(length(p - q), 0, 1e-12) << p.x << ' ' << p.y << ' ' << p.z;
}

// The table has turned the object by 90 degrees counter-clockwise. The point that is now in front
// of the laser was therefore originally 90 degrees clockwise of the laser.
TEST(Position, IsTurnedBackByTheTablesAngle) {
  const Profile profile{90, {}};
  expect_at(position(profile, {{10, 0, 5}}), {0, -10, 5});
  expect_at(position(profile, {{0, 2, 5}}), {2, 0, 5});
}

TEST(Position, OfANegativeRhoIsThatOfHalfATurnFurther) {
  expect_at(position({30, {}}, {{-7, 0, 1}}), position({210, {}}, {{7, 0, 1}}));
}

TEST(Position, OfLateralAndRhoIsRightHanded) {
  const Profile profile{0, {}};
  const Vec3 rho = position(profile, {{1, 0, 0}}), lateral = position(profile, {{0, 1, 0}});
  expect_at(cross(rho, lateral), {0, 0, 1});
}

}  // namespace
}  // namespace vitrine::acquisition
