// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/merge.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "acquisition/surface/shapes.h"
#include "acquisition/surface/surface_of.h"

namespace vitrine::acquisition {
namespace {

// Returns the distance from the origin along a direction. The shape has three different axes, and
// bumps that make every pose unique.
double radius_towards(const Vec3& d) {
  return 20 / std::sqrt(d.x * d.x / 1.2 + d.y * d.y / .8 + d.z * d.z) +
         1.5 * std::sin(3 * d.x + 2 * d.y) + std::cos(4 * d.z + d.x);
}

// Returns a part of the shape, moved by `motion`. It covers the directions whose z is at least
// `from` after the rotation.
TriangleMesh part(const RigidMotion& motion, double from) {
  TriangleMesh mesh;
  constexpr std::uint32_t kAround = 180, kRows = 90;
  for (std::uint32_t j = 0; j < kRows; ++j) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const double z = .999 + (from - .999) * j / (kRows - 1), a = 2 * M_PI * i / kAround;
      const Vec3 turned = {std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a),
                           z};
      const Vec3 d =
          motion.rows[0] * turned.x + motion.rows[1] * turned.y + motion.rows[2] * turned.z;
      mesh.positions.push_back(motion(d * radius_towards(d)));
    }
  }
  for (std::uint32_t j = 0; j + 1 < kRows; ++j) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      mesh.faces.push_back({a, a + kAround, b});
      mesh.faces.push_back({b, a + kAround, b + kAround});
    }
  }
  return mesh;
}

RigidMotion turned_over(double degrees, Vec3 shift) {
  const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
  return {{Vec3{1, 0, 0}, Vec3{0, c, -s}, Vec3{0, s, c}}, shift};
}

TEST(Merge, TwoPosesOfOneObjectBecomeOneSurface) {
  const TriangleMesh top = part({}, -.4);
  const RigidMotion pose = turned_over(180, {3, 1, 2});
  const TriangleMesh bottom = part(pose, -.4);
  // The inverse motion as an operator might estimate it: 4 degrees and 1.5 mm off.
  const RigidMotion start = turned_over(-176, {-2, 0, 1});
  const auto merged = merge(std::vector{top, bottom}, std::vector{RigidMotion{}, start});
  ASSERT_TRUE(merged.has_value()) << merged.error().message;
  double worst = 0, low = 0;
  for (const Vec3& p : merged->mesh.positions) {
    worst = std::max(worst, std::abs(length(p) - radius_towards(p * (1 / length(p)))));
    low = std::min(low, p.z / length(p));
  }
  EXPECT_LT(worst, .1);
  EXPECT_LT(low, -.99);
  EXPECT_LT(merged->rms[1], .05);
  // Both parts extend .4 beyond the middle. So .8 of the 1.4 that each part shows overlap.
  EXPECT_EQ(merged->shares[0], 1);
  EXPECT_NEAR(merged->shares[1], .8 / 1.4, .05);
  EXPECT_FALSE(is_doubtful(*merged, 1, {}));
  // The second scan must not add surface that the first scan shows.
  EXPECT_GT(merged->mesh.faces.size(), top.faces.size());
  EXPECT_LT(merged->mesh.faces.size(), top.faces.size() + bottom.faces.size() * 4 / 5);
}

// A vertex that several faces share is added once.
TEST(Merge, OnlyVerticesOfFacesThatAreAddedAreAdded) {
  const TriangleMesh top = part({}, .5), all = part({}, -.4);
  const auto merged = merge(std::vector{top, all}, std::vector<RigidMotion>(2));
  ASSERT_TRUE(merged.has_value()) << merged.error().message;
  EXPECT_GT(merged->mesh.faces.size(), top.faces.size());
  EXPECT_LE(merged->mesh.positions.size(), top.positions.size() + all.positions.size());
  std::vector<bool> used(merged->mesh.positions.size());
  for (const Triangle& face : merged->mesh.faces) {
    for (const std::uint32_t vertex : face)
      used[vertex] = true;
  }
  EXPECT_EQ(std::ranges::count(used, false), 0);
}

TEST(Merge, AScanThatShowsNothingNewAddsNothingAndNoColours) {
  TriangleMesh top = part({}, -.4);
  top.attributes.colours.resize(top.positions.size());
  const auto merged = merge(std::vector{top, top}, std::vector<RigidMotion>(2));
  ASSERT_TRUE(merged.has_value()) << merged.error().message;
  EXPECT_EQ(merged->mesh.faces.size(), top.faces.size());
  EXPECT_EQ(merged->mesh.positions.size(), top.positions.size());
  EXPECT_TRUE(merged->mesh.attributes.colours.empty());
}

TEST(Merge, ScansThatDoNotMeetAreRefused) {
  const TriangleMesh top = part({}, .5);
  const auto merged =
      merge(std::vector{top, top}, std::vector{RigidMotion{}, turned_over(0, {500, 0, 0})});
  ASSERT_FALSE(merged.has_value());
  EXPECT_THAT(merged.error().message, testing::HasSubstr("scan 2 overlaps"));
}

TEST(Merge, AScanThatOverlapsInLittleOrLooselyIsDoubtful) {
  const auto doubtful = [](double share, double rms) {
    return is_doubtful({.rms = {0, rms}, .shares = {1, share}}, 1, {.overlap = .5});
  };
  EXPECT_FALSE(doubtful(.6, .093));
  EXPECT_TRUE(doubtful(.6, .275));
  EXPECT_TRUE(doubtful(.1, .093));
}

TEST(Merge, OneStartAScanIsNeeded) {
  const auto merged = merge(std::vector{part({}, .5)}, std::vector<RigidMotion>{});
  ASSERT_FALSE(merged.has_value());
  EXPECT_THAT(merged.error().message, testing::HasSubstr("1 scans and 0 starts"));
}

}  // namespace
}  // namespace vitrine::acquisition
