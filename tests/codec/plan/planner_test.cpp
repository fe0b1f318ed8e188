// SPDX-License-Identifier: Apache-2.0
#include "codec/plan/planner.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

// Returns a manifest with levels of 100, 200, 400 and 800 faces. There are two regions from level 2
// on. Each chunk has 1,000 bytes.
Manifest four_levels() {
  Manifest m;
  m.base_offset = 300;
  m.base_length = 700;
  for (std::uint32_t level = 0; level < 4; ++level) {
    m.levels.push_back(
        {.vertices = 50u << level, .faces = 100u << level, .max_error = 8.0 / (1 << level)});
  }
  m.tree.nodes = {{.fork = 2}, {}, {}};
  m.tree.link();
  for (std::uint32_t level = 1; level < 4; ++level) {
    const auto regions = m.tree.regions_at(level);
    for (const std::uint32_t node : regions) {
      m.chunks.push_back({.level = level,
                          .region = m.tree.nodes[node].first,
                          .node = node,
                          .length = 1000,
                          .splits = (25u << level) / static_cast<std::uint32_t>(regions.size())});
    }
  }
  return m;
}

std::vector<std::size_t> plan(const Want& want) {
  const Manifest manifest = four_levels();
  Planner planner(manifest);
  planner.want(want);
  std::vector<std::size_t> chunks;
  while (const auto chunk = planner.next()) {
    planner.have(*chunk);
    chunks.push_back(*chunk);
  }
  return chunks;
}

using Chunks = std::vector<std::size_t>;

TEST(Planner, ALevelIsWantedEverywhere) {
  EXPECT_EQ(plan(WantLevel{0}), Chunks{});
  EXPECT_EQ(plan(WantLevel{2}), (Chunks{0, 1, 2}));
  EXPECT_EQ(plan(WantLevel{99}), (Chunks{0, 1, 2, 3, 4}));
}

TEST(Planner, TrianglesAreReachedByTheChunkThatPassesThem) {
  EXPECT_EQ(plan(WantTriangles{100}), Chunks{});
  EXPECT_EQ(plan(WantTriangles{101}), Chunks{0});
  EXPECT_EQ(plan(WantTriangles{200}), Chunks{0});
  EXPECT_EQ(plan(WantTriangles{201}), (Chunks{0, 1}));
  EXPECT_EQ(plan(WantTriangles{1'000'000}), (Chunks{0, 1, 2, 3, 4}));
}

TEST(Planner, BytesAreNeverExceeded) {
  EXPECT_EQ(plan(WantBytes{0}), Chunks{});
  EXPECT_EQ(plan(WantBytes{1'999}), Chunks{});
  EXPECT_EQ(plan(WantBytes{2'000}), Chunks{0});
  EXPECT_EQ(plan(WantBytes{4'500}), (Chunks{0, 1, 2}));
}

TEST(Planner, AnErrorIsMetByTheCoarsestLevelBelowIt) {
  EXPECT_EQ(plan(WantError{8}), Chunks{});
  EXPECT_EQ(plan(WantError{7.9}), Chunks{0});
  EXPECT_EQ(plan(WantError{2}), (Chunks{0, 1, 2}));
  EXPECT_EQ(plan(WantError{0}), (Chunks{0, 1, 2, 3, 4}));
}

// Tests that the work of a step does not grow with the number of chunks held. Otherwise this test
// would take minutes.
TEST(Planner, ManyChunksArePlannedOneAfterTheOther) {
  constexpr std::uint32_t kLevels = 300'000;
  Manifest m;
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    m.levels.push_back({.vertices = 4 + level, .faces = 4 + 2 * level});
    if (level > 0) m.chunks.push_back({.level = level, .length = 10, .splits = 1});
  }
  Planner planner(m);
  planner.want(WantTriangles{1'000'000});
  for (std::size_t i = 0; i + 1 < kLevels; ++i) {
    ASSERT_EQ(planner.next(), std::optional(i));
    planner.have(i);
  }
  EXPECT_EQ(planner.next(), std::nullopt);
  EXPECT_EQ(planner.faces_held(), m.levels.back().faces);
  EXPECT_EQ(planner.bytes_held(), 10u * m.chunks.size());
}

TEST(Planner, WhatIsHeldIsCountedAndNotAskedForAgain) {
  const Manifest manifest = four_levels();
  Planner planner(manifest);
  EXPECT_EQ(planner.bytes_held(), 1'000u);
  EXPECT_EQ(planner.faces_held(), 100u);
  planner.have(0);
  planner.have(1);
  planner.have(1);
  planner.have(1'000);  // unknown chunks are ignored
  EXPECT_EQ(planner.bytes_held(), 3'000u);
  EXPECT_EQ(planner.faces_held(), 300u);
  planner.want(WantLevel{3});
  EXPECT_EQ(planner.next(), std::optional<std::size_t>(2));
}

}  // namespace
}  // namespace vitrine
