// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/fuse.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "acquisition/alignment/bumpy_scans.h"
#include "acquisition/alignment/rigid_pose.h"

namespace vitrine::acquisition {
namespace {

constexpr double kSame = .5;  // distance, in mm, within which two scans show the same surface

TEST(FusedSurface, TwoPosesOfOneObjectBecomeOneSurface) {
  const RigidMotion pose = rotation_about({1, 0, 0}, 180, {3, 1, 2});
  const std::vector scans = {scan_of(bumpy, {}, -.4), scan_of(bumpy, pose, -.4)};
  const TriangleMesh mesh = fused_surface(scans, std::vector{RigidMotion{}, inverse(pose)}, kSame);
  double worst = 0, low = 0;
  for (const Vec3& p : mesh.positions) {
    worst = std::max(worst, std::abs(length(p) - bumpy(p * (1 / length(p)))));
    low = std::min(low, p.z / length(p));
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_LT(low, -.99);
  // The second scan must not add surface that the first scan already shows.
  EXPECT_GT(mesh.faces.size(), scans[0].mesh.faces.size());
  EXPECT_LT(mesh.faces.size(), scans[0].mesh.faces.size() + scans[1].mesh.faces.size() * 4 / 5);
}

// A vertex that several added faces share must be added only once.
TEST(FusedSurface, OnlyVerticesOfFacesThatAreAddedAreAdded) {
  const std::vector scans = {scan_of(bumpy, {}, .5), scan_of(bumpy, {}, -.4)};
  const TriangleMesh mesh = fused_surface(scans, std::vector<RigidMotion>(2), kSame);
  EXPECT_GT(mesh.faces.size(), scans[0].mesh.faces.size());
  std::vector<bool> used(mesh.positions.size());
  for (const Triangle& face : mesh.faces) {
    for (const std::uint32_t vertex : face)
      used[vertex] = true;
  }
  EXPECT_EQ(std::ranges::count(used, false), 0);
}

TEST(FusedSurface, AScanThatShowsNothingNewAddsNothingAndNoColours) {
  PoseScan top = scan_of(bumpy, {}, -.4);
  top.mesh.attributes.colours.resize(top.mesh.positions.size());
  const TriangleMesh mesh =
      fused_surface(std::vector{top, top}, std::vector<RigidMotion>(2), kSame);
  EXPECT_EQ(mesh.faces, top.mesh.faces);
  EXPECT_EQ(mesh.positions, top.mesh.positions);
  EXPECT_TRUE(mesh.attributes.colours.empty());
}

// Seams between scans are not stitched, so the rims on both sides of a seam stay open. A part that
// no scan has seen stays a hole.
TEST(FusedSurface, HolesAndSeamsStayOpen) {
  const RigidMotion pose = rotation_about({1, 0, 0}, 180);
  const std::vector scans = {scan_of(bumpy, {}, .2), scan_of(bumpy, pose, .2)};
  const TriangleMesh mesh = fused_surface(scans, std::vector{RigidMotion{}, inverse(pose)}, kSame);
  EXPECT_EQ(mesh.faces.size(), scans[0].mesh.faces.size() + scans[1].mesh.faces.size());
}

}  // namespace
}  // namespace vitrine::acquisition
