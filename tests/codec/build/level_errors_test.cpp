// SPDX-License-Identifier: Apache-2.0
// Checks the geometric errors that a finished build states for its levels: the maximum distances
// from the original surface.
#include "codec/build/level_errors.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "codec/build/build_model.h"
#include "codec/build/open_model.h"
#include "codec/distance/surface_distance.h"
#include "codec/export/write_mesh.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

std::vector<std::uint8_t> file() {
  return *write_mesh(torus(240, 120), MeshFormat::kPly);
}

TEST(LevelErrors, NoLevelIsFartherOffThanItStatesNorMuchNearer) {
  const auto built = build_model(file(), {.bits = 16}, {});
  ASSERT_TRUE(built);
  auto refiner = open_model(built->file);
  ASSERT_TRUE(refiner);
  const ChunkReader read = chunks_of(refiner->manifest(), built->file);
  const std::size_t levels = refiner->manifest().levels.size();
  EXPECT_TRUE(std::ranges::any_of(refiner->manifest().levels,
                                  [](const LevelInfo& l) { return l.display_filter != 0; }));
  for (std::uint32_t level = 0; level < levels; ++level) {
    SCOPED_TRACE(level);
    ASSERT_TRUE(refine(*refiner, WantLevel{level}, read));
    const double stated = refiner->manifest().levels[level].max_error;
    const auto sampled = measure(refiner->display_mesh(), torus(240, 120), {.samples = 20'000});
    EXPECT_LE(sampled->max, stated * (1 + 1e-9));
    EXPECT_GE(sampled->max, stated * 0.6);
  }
}

// Returns an OBJ file of one polygon: a strip with long teeth on both sides.
std::vector<std::uint8_t> comb(int corners) {
  std::string text, face = "f";
  for (int i = 0; i < corners; ++i) {
    const int half = corners / 2, x = i < half ? i : corners - 1 - i, tooth = x % 2 * 100;
    text += fmt::format("v {} {} 0\n", x, i < half ? tooth : -5 - tooth);
    face += fmt::format(" {}", i + 1);
  }
  text += face + "\n";
  return {text.begin(), text.end()};
}

TEST(LevelErrors, OfACombWithManyTeethAreBounded) {
  constexpr int kCorners = 2'000;
  const auto built = build_model(comb(kCorners), {}, {});
  ASSERT_TRUE(built);
  for (const LevelInfo& level : built->report.manifest.levels)
    EXPECT_LE(level.max_error, kCorners / 4);
}

std::vector<std::uint8_t> built_on(unsigned threads, Placement placement) {
  const BuildOptions options{
      .bits = 16, .placement = placement, .region_vertices = 2'000, .threads = threads};
  const auto built = build_model(file(), options, {});
  if (!built) return {};
  EXPECT_GT(built->report.manifest.tree.leaves(), 4u);
  return built->file;
}

TEST(LevelErrors, AreTheSameHoweverManyThreadsMeasure) {
  for (const Placement placement : {Placement::kMidpoint, Placement::kPyramid}) {
    const auto one = built_on(1, placement);
    ASSERT_FALSE(one.empty());
    for (const unsigned threads : {2u, 3u, 4u})
      EXPECT_EQ(built_on(threads, placement), one) << threads << " threads";
  }
}

}  // namespace
}  // namespace vitrine::test
