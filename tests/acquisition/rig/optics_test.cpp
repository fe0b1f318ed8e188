// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vitrine::acquisition::rig {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(Optics, ARayIsTheWayBackOfAProjection) {
  const Lens lens = optics_of(1).camera;
  for (const ImagePoint at :
       {ImagePoint{0, 0}, ImagePoint{1299, 1029}, ImagePoint{640.25, 900.5}, ImagePoint{1299, 0}}) {
    const auto back = project(lens, lens.at + ray(lens, at) * 321);
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->u, at.u, 1e-6);
    EXPECT_NEAR(back->v, at.v, 1e-6);
  }
}

TEST(Optics, TheLensDistortsByPixels) {
  const Lens lens = optics_of(1).camera;
  Lens straight = lens;
  straight.k1 = straight.k2 = straight.p1 = straight.p2 = 0;
  const Vec3 corner = lens.at + ray(lens, {20, 20}) * 300;
  EXPECT_GT(std::abs(project(lens, corner)->u - project(straight, corner)->u), 2);
}

TEST(Optics, APointBehindTheLensHasNoPixel) {
  const Lens lens = optics_of(1).camera;
  EXPECT_FALSE(project(lens, lens.at - lens.forward));
}

TEST(Optics, NoSeedTriangulatesByMoreThanThirtyDegrees) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Optics optics = optics_of(seed);
    const double angle = std::asin(std::abs(dot(optics.camera.forward, optics.laser.normal)));
    EXPECT_LE(angle, 30 * kDegree);
    EXPECT_GE(angle, 20 * kDegree);
  }
}

TEST(Optics, TheWholeObjectIsInViewOfEverySeed) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Lens camera = optics_of(seed).camera;
    for (int azimuth = 0; azimuth < 360; azimuth += 5) {
      for (const double z : {0.0, 80.0}) {
        const auto pixel = project(
            camera, {45 * std::cos(azimuth * kDegree), 45 * std::sin(azimuth * kDegree), z});
        ASSERT_TRUE(pixel);
        EXPECT_TRUE(pixel->u > 8 && pixel->u < kSensorWidth - 8) << seed << " u " << pixel->u;
        EXPECT_TRUE(pixel->v > 8 && pixel->v < kSensorHeight - 8) << seed << " v " << pixel->v;
      }
    }
  }
}

TEST(Optics, TheSourceIsInTheSheetAndTheAxisBesideIt) {
  for (std::uint64_t seed = 1; seed < 50; ++seed) {
    const LaserSheet laser = optics_of(seed).laser;
    EXPECT_NEAR(dot(laser.normal, laser.source), laser.offset, 1e-9);
    EXPECT_NE(laser.offset, 0);
    EXPECT_NE(laser.normal.z, 0);
    EXPECT_EQ(laser.normal.x, 0);
  }
}

TEST(Optics, AnotherSeedIsAnotherRig) {
  bool some_clockwise = false, all_clockwise = true;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Optics a = optics_of(seed), b = optics_of(seed + 1);
    const ImagePoint p = *project(a.camera, {10, 0, 40}), q = *project(b.camera, {10, 0, 40});
    EXPECT_GT(std::hypot(p.u - q.u, p.v - q.v), 0.5);
    some_clockwise |= a.is_clockwise;
    all_clockwise &= a.is_clockwise;
  }
  EXPECT_TRUE(some_clockwise && !all_clockwise);
}

TEST(Optics, TheTableTurnsClockwiseOrNotAndBack) {
  Optics optics;
  EXPECT_NEAR(turned(optics, 90, {1, 0, 5}).y, 1, 1e-12);
  EXPECT_NEAR(turned_back(optics, 90, {0, 1, 5}).x, 1, 1e-12);
  optics.is_clockwise = true;
  EXPECT_NEAR(turned(optics, 90, {1, 0, 5}).y, -1, 1e-12);
}

}  // namespace
}  // namespace vitrine::acquisition::rig
