// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/align_scans.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "acquisition/alignment/bumpy_scans.h"
#include "acquisition/alignment/rigid_pose.h"

namespace vitrine::acquisition {
namespace {

using testing::HasSubstr;

// Returns the largest distance, in mm, between the scan's vertices moved by `motion` and their true
// places in the object's frame.
double pose_error(const PoseScan& scan, const RigidMotion& motion, const RigidMotion& pose) {
  double worst = 0;
  for (const Vec3& p : scan.mesh.positions)
    worst = std::max(worst, length(motion(p) - inverse(pose)(p)));
  return worst;
}

std::string refusal(const std::vector<PoseScan>& scans) {
  const auto result = align_scans(scans);
  EXPECT_FALSE(result.has_value());
  return result ? "" : result.error().message;
}

TEST(AlignScans, ThePoseOfASecondScanIsFoundWithoutAStart) {
  const RigidMotion pose = rotation_about({1, .3, .2}, 163, {4, -9, 15});
  const std::vector scans = {scan_of(bumpy, {}, -.5), scan_of(bumpy, pose, -.5)};
  const auto result = align_scans(scans);
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_LT(pose_error(scans[0], result->motions[0], {}), 1e-9);
  EXPECT_LT(pose_error(scans[1], result->motions[1], pose), .1);
  ASSERT_EQ(result->pairs.size(), 1U);
  EXPECT_LT(result->pairs[0].rms, .05);
  EXPECT_LT(result->pairs[0].crossed, .01);
  EXPECT_GT(result->pairs[0].overlap, .4);
}

TEST(AlignScans, EqualScansAndSeedGiveEqualMotions) {
  const std::vector scans = {scan_of(bumpy, {}, -.5),
                             scan_of(bumpy, rotation_about({0, 1, 0}, 70), -.5)};
  const auto a = align_scans(scans, {.seed = 7}), b = align_scans(scans, {.seed = 7});
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->motions[1].rows, b->motions[1].rows);
  EXPECT_EQ(a->motions[1].shift, b->motions[1].shift);
}

// The first and the last scan show opposite sides of the object, so they are joined through the
// second scan.
TEST(AlignScans, AScanMayBeJoinedThroughAnotherOne) {
  const RigidMotion side = rotation_about({1, 0, 0}, 90), over = rotation_about({1, 0, 0}, 180);
  const std::vector scans = {scan_of(bumpy, {}, .05), scan_of(bumpy, over, .05),
                             scan_of(bumpy, side, -.6)};
  const auto result = align_scans(scans);
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_LT(pose_error(scans[1], result->motions[1], over), .15);
  EXPECT_LT(pose_error(scans[2], result->motions[2], side), .15);
}

TEST(AlignScans, ASymmetricBodyIsRefused) {
  for (const auto& shape : {Radius(vase), Radius(cube)}) {
    EXPECT_THAT(refusal({scan_of(shape, {}, -.9, "top.scan"),
                         scan_of(shape, rotation_about({.2, 1, 0}, 40), -.9, "side.scan")}),
                AllOf(HasSubstr("side.scan and top.scan fit together in more than one way"),
                      HasSubstr("scan one more pose")));
  }
}

TEST(AlignScans, TooLittleOverlapIsRefused) {
  EXPECT_THAT(refusal({scan_of(bumpy, {}, .3, "top.scan"),
                       scan_of(bumpy, rotation_about({1, 0, 0}, 180), .3, "bottom.scan")}),
              AllOf(HasSubstr("bottom.scan and top.scan do not overlap enough"),
                    HasSubstr("scan one more pose")));
}

TEST(AlignScans, AScanWithoutFacesAndASingleScanAreRefused) {
  EXPECT_THAT(refusal({scan_of(bumpy, {}, .5)}), HasSubstr("there are 1 scans; give 2 to 16"));
  EXPECT_THAT(refusal({scan_of(bumpy, {}, .5), {"empty.scan", {}, {}}}),
              HasSubstr("empty.scan has no face"));
}

}  // namespace
}  // namespace vitrine::acquisition
