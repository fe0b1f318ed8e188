// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/patch_cover.h"

#include <gtest/gtest.h>

#include <utility>

namespace vitrine::test {
namespace {

const Corners kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

// One triangle over x >= -reach, y >= -reach, x + y <= 2 * reach, on z = 0.1 + slope * x.
TriangleMesh slope(double reach, double slope) {
  const auto at = [&](double x, double y) { return Vec3{x, y, 0.1 + slope * x}; };
  return {.positions = {at(-reach, -reach), at(3 * reach, -reach), at(-reach, 3 * reach)},
          .faces = {{0, 1, 2}}};
}

PatchCover::Result cover(const TriangleMesh& mesh, double limit) {
  const TriangleBvh bvh(mesh);
  const WitnessSurface surface(bvh);
  return PatchCover(surface).cover(kTriangle, 0, limit, 1);
}

TEST(PatchCover, CountsTheHeightOverTheTriangleOnly) {
  const PatchCover::Result result = cover(slope(50, 0.5), 0.7);  // 75 high elsewhere
  EXPECT_TRUE(result.covered);
  EXPECT_NEAR(result.height, 0.6, 1e-12);
}

TEST(PatchCover, RefusesWhatIsTooHighSomewhereOverTheTriangle) {
  EXPECT_FALSE(cover(slope(50, 0.5), 0.5).covered);
}

TEST(PatchCover, RefusesAPatchThatEndsOverTheTriangle) {
  EXPECT_TRUE(cover(slope(0.6, 0), 0.2).covered);
  EXPECT_FALSE(cover(slope(0.4, 0), 0.2).covered);
}

TEST(PatchCover, RefusesWhatFacesAway) {
  TriangleMesh mesh = slope(50, 0);
  for (Triangle& f : mesh.faces)
    std::swap(f[0], f[1]);
  EXPECT_FALSE(cover(mesh, 1).covered);
}

}  // namespace
}  // namespace vitrine::test
