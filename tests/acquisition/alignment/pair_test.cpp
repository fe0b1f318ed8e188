// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <random>

#include "acquisition/alignment/bumpy_scans.h"
#include "acquisition/alignment/choose_pose.h"
#include "acquisition/alignment/point_features.h"
#include "acquisition/alignment/ray_cast.h"
#include "acquisition/alignment/rigid_pose.h"

namespace vitrine::acquisition {
namespace {

// Distance in mm between neighbouring points, and distance in mm below which two surfaces count as
// one.
constexpr double kSpacing = 1, kReach = .5;

TEST(PointFeatures, DoNotDependOnThePose) {
  const SurfacePoints points = evenly_spaced(scan_of(bumpy, {}, 0).mesh, kSpacing);
  SurfacePoints moved = points;
  const RigidMotion pose = rotation_about({1, 2, 3}, 100, {5, 6, 7});
  for (std::size_t i = 0; i < points.size(); ++i)
    moved.at[i] = pose(points.at[i]), moved.normals[i] = turned(pose, points.normals[i]);
  const auto a = point_features(points, 5), b = point_features(moved, 5);
  ASSERT_EQ(a.size(), b.size());
  const auto matches = mutual_matches(a, b);
  EXPECT_GT(matches.size(), points.size() * 9 / 10);
  for (const FeatureMatch& match : matches)
    EXPECT_EQ(match.from, match.to);
}

TEST(MutualMatches, OnlyPairsThatChooseEachOtherMatch) {
  std::vector<PointFeature> from(2, PointFeature{}), to(20, PointFeature{});
  for (PointFeature& feature : to)
    feature[5] = 50;
  // Feature 18 of `to` is the closest to both features of `from`. Feature 0 of `from` is the
  // closest to feature 18, so only this pair matches.
  to[18][5] = 1, from[1][5] = 3;
  const auto matches = mutual_matches(from, to);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].from, 0U);
  EXPECT_EQ(matches[0].to, 18U);
  EXPECT_TRUE(mutual_matches({}, to).empty());
  EXPECT_TRUE(mutual_matches(from, {}).empty());
}

TEST(RayCast, AgreesWithEveryTriangleByItself) {
  const TriangleMesh mesh = scan_of(bumpy, {}, -.2).mesh;
  const TriangleBvh surface(mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-30, 30);
  int count = 0;
  for (int ray = 0; ray < 200; ++ray) {
    const Vec3 origin = {draw(random), draw(random), draw(random)},
               direction = {draw(random), draw(random), ray % 5 == 0 ? 0 : draw(random)};
    bool expected = false;
    for (const Triangle& f : mesh.faces) {
      const TriangleMesh one{
          {mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]}, {{0, 1, 2}}, {}};
      expected = expected || hits(TriangleBvh(one), origin, direction);
    }
    count += expected ? 1 : 0;
    EXPECT_EQ(hits(surface, origin, direction), expected) << "ray " << ray;
  }
  EXPECT_GT(count, 20);
  EXPECT_LT(count, 180);
  EXPECT_TRUE(hits(surface, {0, 0, 50}, {0, .1, -1}));
  EXPECT_FALSE(hits(surface, {0, 0, 50}, {0, .1, 1}));
}

TEST(CrossedShare, TellsARightPoseFromAWrongOne) {
  const RigidMotion pose = rotation_about({1, 0, 0}, 60);
  const PreparedScan from(scan_of(bumpy, pose, -.5), kSpacing),
      to(scan_of(bumpy, {}, -.5), kSpacing);
  const RigidMotion right = inverse(pose), wrong = then(right, rotation_about({0, 0, 1}, 90));
  EXPECT_EQ(crossed_share(from.lines(), to.surface(), right), 0);
  EXPECT_GT(crossed_share(from.lines(), to.surface(), wrong), .1);
  EXPECT_FALSE(is_contradicted(judge_pair(from, to, right, kReach), kReach));
  EXPECT_TRUE(is_contradicted(judge_pair(from, to, wrong, kReach), kReach));
}

// Light cannot have passed along a sight line that crosses the scan's own surface, so such a line
// must be discarded.
TEST(CrossedShare, LinesThatTheScanItselfBlocksDoNotCount) {
  PoseScan scan = scan_of(bumpy, {}, -.5);
  const std::size_t free = PreparedScan(scan, kSpacing).lines().size();
  scan.lines.push_back({{0, 0, 0}, {.6, 0, .8}});
  EXPECT_EQ(PreparedScan(scan, kSpacing).lines().size(), free);
}

TEST(ChoosePose, RefusesWhatIsContradictedTooLittleOrAmbiguous) {
  const auto verdict = [](std::vector<PairFit> fits) { return choose_pose(fits, kReach).verdict; };
  const PairFit right = {.overlap = .5, .rms = .05, .crossed = .01},
                crossing = {.overlap = .6, .rms = .05, .crossed = .07},
                loose = {.overlap = .6, .rms = .18, .crossed = 0},
                little = {.overlap = .05, .rms = .05, .crossed = 0},
                rival = {.overlap = .4, .rms = .06, .crossed = .01};
  EXPECT_EQ(verdict({}), PoseVerdict::kNone);
  EXPECT_EQ(verdict({crossing, loose, little}), PoseVerdict::kNone);
  EXPECT_EQ(verdict({crossing, loose, right, little}), PoseVerdict::kAccepted);
  EXPECT_EQ(verdict({right, rival}), PoseVerdict::kAmbiguous);
}

}  // namespace
}  // namespace vitrine::acquisition
