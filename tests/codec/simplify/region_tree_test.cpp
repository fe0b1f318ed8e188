// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/region_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace vitrine::test {
namespace {

std::vector<Vec3i> random_points(std::size_t count) {
  std::mt19937 random(11);
  std::vector<Vec3i> points(count);
  for (Vec3i& p : points) {
    p = {static_cast<std::int32_t>(random() % 4096), static_cast<std::int32_t>(random() % 2048),
         static_cast<std::int32_t>(random() % 1024)};
  }
  return points;
}

// Goes down the tree as a reader of the planes does.
std::uint32_t region_of(const Vec3i& p, const std::vector<RegionPlane>& planes,
                        std::uint32_t regions) {
  std::uint32_t first = 0, plane = 0;
  while (regions > 1) {
    const RegionPlane& cut = planes[plane];
    const std::int32_t at = cut.axis == 0 ? p.x : cut.axis == 1 ? p.y : p.z;
    const std::uint32_t left = regions / 2;
    if (at < cut.at) {
      ++plane, regions = left;
    } else {
      first += left, plane += left, regions -= left;
    }
  }
  return first;
}

TEST(RegionTree, LabelsAreWhatThePlanesSay) {
  const std::vector<Vec3i> points = random_points(5000);
  for (std::uint32_t regions : {1u, 2u, 3u, 7u, 16u, 100u}) {
    const RegionTree tree = build_region_tree(points, regions);
    ASSERT_EQ(tree.planes.size(), regions - 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(tree.region[i], region_of(points[i], tree.planes, regions));
    }
  }
}

TEST(RegionTree, RegionsAreAboutEquallyLarge) {
  for (std::uint32_t regions : {2u, 3u, 7u, 16u, 100u}) {
    const RegionTree tree = build_region_tree(random_points(5000), regions);
    std::vector<std::uint32_t> size(regions, 0);
    for (std::uint16_t r : tree.region)
      ++size[r];
    const auto [least, most] = std::minmax_element(size.begin(), size.end());
    EXPECT_GT(*least, 5000 / regions * 9 / 10 - 5) << regions << " regions";
    EXPECT_LT(*most, 5000 / regions * 11 / 10 + 5) << regions << " regions";
  }
}

TEST(RegionTree, TheLongestSideIsCutFirst) {
  const RegionTree tree = build_region_tree(random_points(5000), 2);
  EXPECT_EQ(tree.planes[0].axis, 0);
  EXPECT_NEAR(tree.planes[0].at, 2048, 100);
}

TEST(RegionTree, CopesWithPointsThatCoincideAndWithNone) {
  EXPECT_EQ(build_region_tree(std::vector<Vec3i>(10), 4).planes.size(), 3u);
  EXPECT_EQ(build_region_tree({}, 4).planes.size(), 3u);
}

}  // namespace
}  // namespace vitrine::test
