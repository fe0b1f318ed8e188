// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/region_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
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

// Returns the leaf that contains a point. Follows the split planes down the tree, as a decoder
// does.
std::uint32_t leaf_of(const Vec3i& p, const RegionTree& tree) {
  std::uint32_t node = 0;
  while (tree.nodes[node].fork != 0)
    node = tree.nodes[node].plane.is_beyond(p) ? tree.nodes[node].second : node + 1;
  return tree.nodes[node].first;
}

TEST(RegionTree, LabelsAreWhatThePlanesSay) {
  const std::vector<Vec3i> points = random_points(5000);
  for (const std::uint32_t capacity : {1u, 7u, 300u, 2499u, 5000u}) {
    const RegionLabels labels = label_regions(points, capacity);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(labels.leaf[i], leaf_of(points[i], labels.tree));
    }
  }
}

TEST(RegionTree, RegionsAreAboutEquallyLarge) {
  for (const std::uint32_t capacity : {50u, 300u, 2600u, 5000u}) {
    const RegionLabels labels = label_regions(random_points(5000), capacity);
    std::vector<std::uint32_t> size(labels.tree.leaves(), 0);
    for (const std::uint16_t leaf : labels.leaf)
      ++size[leaf];
    const auto [least, most] = std::minmax_element(size.begin(), size.end());
    EXPECT_GE(*least, capacity * 2 / 5) << capacity;
    EXPECT_LE(*most, capacity);
  }
}

TEST(RegionTree, TheLongestSideIsCutFirst) {
  const RegionTree tree = label_regions(random_points(5000), 2600).tree;
  ASSERT_EQ(tree.nodes.size(), 3u);
  EXPECT_EQ(tree.nodes[0].plane.axis, 0);
  EXPECT_NEAR(tree.nodes[0].plane.at, 2048, 100);
}

TEST(RegionTree, CopesWithPointsThatCoincideAndWithNone) {
  EXPECT_EQ(label_regions(std::vector<Vec3i>(10), 4).tree.leaves(), 1u);
  EXPECT_EQ(label_regions({}, 4).tree.leaves(), 1u);
  std::vector<Vec3i> two_places(10);
  std::fill_n(two_places.begin(), 8, Vec3i{-1, 0, 0});
  EXPECT_EQ(label_regions(two_places, 4).tree.leaves(), 2u);
}

TEST(RegionJoiner, SiblingsJoinOnceTheyAreSmallEnough) {
  RegionLabels labels = label_regions(random_points(4000), 1000);
  ASSERT_EQ(labels.tree.leaves(), 4u);
  RegionJoiner joiner(labels.tree);
  std::vector<VertexId> live(4000);
  std::iota(live.begin(), live.end(), 0u);
  joiner.join(live, 1000, labels.leaf);
  EXPECT_FALSE(joiner.is_whole());
  joiner.join(live, 2100, labels.leaf);
  EXPECT_FALSE(joiner.is_whole());
  EXPECT_EQ(*std::ranges::max_element(labels.leaf), 2);
  EXPECT_FALSE(RegionJoiner(joiner).finish(3)) << "the coarsest level has two regions";
  joiner.join(live, 4000, labels.leaf);
  EXPECT_TRUE(joiner.is_whole());
  ASSERT_TRUE(joiner.finish(4));
  EXPECT_EQ(labels.tree.regions_at(2).size(), 1u);
  EXPECT_EQ(labels.tree.regions_at(3).size(), 2u);
  EXPECT_EQ(labels.tree.regions_at(4).size(), 4u);
}

}  // namespace
}  // namespace vitrine::test
