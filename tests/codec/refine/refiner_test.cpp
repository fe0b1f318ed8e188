// SPDX-License-Identifier: Apache-2.0
#include "codec/refine/refiner.h"

#include <gtest/gtest.h>

#include "codec/build/refine.h"
#include "support/meshes.h"
#include "support/stored_model.h"

namespace vitrine {
namespace {

using test::StoredModel;

StoredModel torus_model(std::uint32_t region_vertices = 0) {
  const TriangleMesh torus = test::torus(40, 24);
  return test::store_model(quantise(torus, fit_lattice(torus.positions, 12)),
                           {.target_vertices = 40, .region_vertices = region_vertices});
}

ChunkReader reader(const StoredModel& model) {
  return [&](std::size_t i) -> Expected<std::span<const std::uint8_t>> { return model.chunk(i); };
}

TEST(Refiner, EveryLevelHasItsCountsAndIsShownWithItsFilter) {
  StoredModel model = torus_model();
  for (LevelInfo& level : model.manifest.levels)
    level.display_filter = 0.5;
  model.manifest.levels.back().display_filter = 0;
  Refiner refiner = test::start_refiner(model);
  for (std::uint32_t level = 0; level < model.manifest.levels.size(); ++level) {
    ASSERT_TRUE(refine(refiner, WantLevel{level}, reader(model)));
    EXPECT_EQ(refiner.face_count(), model.manifest.levels[level].faces);
    const bool last = level + 1 == model.manifest.levels.size();
    EXPECT_EQ(refiner.display_position(0) == to_vec3(refiner.positions()[0]), last)
        << "level " << level;
  }
}

TEST(Refiner, TrianglesAreMetWithinOneSplit) {
  const StoredModel model = torus_model();
  for (std::uint64_t wanted = model.manifest.levels[0].faces; wanted < 1900; wanted += 97) {
    Refiner refiner = test::start_refiner(model);
    ASSERT_TRUE(refine(refiner, WantTriangles{wanted}, reader(model)));
    EXPECT_LE(refiner.face_count(), wanted);
    EXPECT_GE(refiner.face_count() + 1, wanted);
  }
}

TEST(Refiner, AChunkOutOfOrderIsRefusedAndHarmsNothing) {
  const StoredModel model = torus_model();
  Refiner refiner = test::start_refiner(model);
  EXPECT_FALSE(refiner.is_ready(1));
  EXPECT_EQ(refiner.apply(1, model.chunk(1)).error().code, ErrorCode::kState);
  EXPECT_EQ(refiner.apply(99'999, model.chunk(0)).error().code, ErrorCode::kState);
  EXPECT_TRUE(refiner.apply(0, model.chunk(0)));
  EXPECT_EQ(refiner.apply(0, model.chunk(0)).error().code, ErrorCode::kState);
  EXPECT_TRUE(refiner.apply(1, model.chunk(1)));
}

TEST(Refiner, AChunkCutShortIsRefusedAndMayComeAgain) {
  const StoredModel model = torus_model();
  Refiner refiner = test::start_refiner(model);
  const auto chunk = model.chunk(0);
  EXPECT_EQ(refiner.apply(0, chunk.first(chunk.size() - 1)).error().code, ErrorCode::kBadInput);
  EXPECT_TRUE(refiner.apply(0, chunk));
}

TEST(Refiner, NothingCanBeAppliedAfterSplitsWereTakenBack) {
  const StoredModel model = torus_model();
  Refiner refiner = test::start_refiner(model);
  ASSERT_TRUE(refiner.apply(0, model.chunk(0)));
  refiner.undo_to_faces(refiner.face_count() - 1);
  EXPECT_FALSE(refiner.is_ready(1));
  EXPECT_EQ(refiner.apply(1, model.chunk(1)).error().code, ErrorCode::kState);
}

TEST(Refiner, ARegionWaitsForItsNeighbours) {
  const StoredModel model = torus_model(300);
  const Manifest& m = model.manifest;
  const std::uint32_t fork = m.tree.nodes[0].fork;
  ASSERT_GT(fork, 0u);
  ASSERT_GT(m.levels.size(), fork + 1) << "the regions need two levels";
  Refiner refiner = test::start_refiner(model);
  for (std::uint32_t level = 1; level < fork; ++level)
    test::apply_chunk(refiner, model, m.find_chunk(level, 0));
  const std::size_t first = m.find_chunk(fork, 0), next = m.find_chunk(fork + 1, 0);
  test::apply_chunk(refiner, model, first);
  EXPECT_FALSE(refiner.is_ready(next)) << "the other half is a level behind";
  for (std::size_t i = first + 1; m.chunks[i].level == fork; ++i)
    test::apply_chunk(refiner, model, i);
  EXPECT_TRUE(refiner.is_ready(next));
}

TEST(Refiner, RegionsForkAtSeveralLevels) {
  const StoredModel model = torus_model(100);
  const RegionTree& tree = model.manifest.tree;
  ASSERT_GE(tree.leaves(), 8u);
  EXPECT_EQ(tree.regions_at(1).size(), 1u);
  const auto last = static_cast<std::uint32_t>(model.manifest.levels.size() - 1);
  EXPECT_EQ(tree.regions_at(last).size(), tree.leaves());
  std::size_t before = 1;
  for (std::uint32_t level = 2; level <= last; ++level) {
    EXPECT_GE(tree.regions_at(level).size(), before);
    before = tree.regions_at(level).size();
  }
  EXPECT_GT(tree.regions_at(last - 1).size(), 1u);
  EXPECT_LT(tree.regions_at(last - 1).size(), tree.leaves());
}

TEST(Refiner, RefusesABaseThatIsNotTheOneOfTheHeader) {
  const StoredModel model = torus_model();
  const auto refused = [&](auto change) {
    BaseMesh base = model.base;
    change(base);
    return !Refiner::start(model.manifest, base);
  };
  EXPECT_FALSE(refused([](BaseMesh&) {}));
  EXPECT_TRUE(refused([](BaseMesh& b) { b.faces.pop_back(); }));
  EXPECT_TRUE(refused([](BaseMesh& b) { b.positions.push_back({}); }));
  EXPECT_TRUE(refused([](BaseMesh& b) { b.faces[0][0] = 9'999; }));
  EXPECT_TRUE(refused([](BaseMesh& b) { b.faces[0][0] = b.faces[0][1]; }));
  EXPECT_TRUE(refused([](BaseMesh& b) { b.positions[0].x = 1 << 30; }));
  EXPECT_TRUE(refused([](BaseMesh& b) {
    b.attributes = {{Semantic::kColour, std::vector<Vec3i>(b.positions.size())}};
  }));
}

TEST(Refiner, RefusesColoursOutOfRange) {
  StoredModel model = torus_model();
  model.manifest.attributes = {Semantic::kColour};
  model.base.attributes = {
      {Semantic::kColour, std::vector<Vec3i>(model.base.positions.size(), Vec3i{1 << 30, 0, 0})}};
  EXPECT_FALSE(Refiner::start(model.manifest, model.base));
}

}  // namespace
}  // namespace vitrine
