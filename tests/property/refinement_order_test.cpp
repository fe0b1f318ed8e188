// SPDX-License-Identifier: Apache-2.0
// Tests that every permitted order of chunks gives the same mesh. A chunk may be applied once its
// region and all adjacent regions have the previous level. Also tests that vertex splits can be
// undone.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "codec/coding/component_pass.h"
#include "codec/format/cell.h"
#include "support/product_names.h"
#include "support/random_mesh.h"
#include "support/seeds.h"
#include "support/stored_model.h"

namespace vitrine::test {
namespace {

using SurfaceFaces = std::vector<SurfaceFace>;

constexpr std::uint32_t kOrders = 4;

StoredModel random_model(std::uint64_t seed) {
  Dice dice(~seed);
  LatticeMesh fine = random_mesh(seed, 400);
  if (dice.one_in(2)) add_specks(fine, dice.below(60), seed);
  return store_model(fine, {.placement = seed % 2 == 0 ? Placement::kMidpoint : Placement::kPyramid,
                            .target_vertices = 6,
                            .region_vertices = 16 + dice.below(60)});
}

void expect_manifold(const Refiner& refiner) {
  const LatticeMesh mesh = refiner.lattice_mesh();
  ASSERT_EQ(mesh.faces.size(), refiner.face_count());
  const auto closed = Connectivity::close(refiner.vertex_count(), mesh.faces);
  ASSERT_TRUE(closed) << closed.error().message;
  ASSERT_EQ(closed->loop_count(), refiner.connectivity().loop_count());
}

// Applies all chunks in a random order. `known` holds the surface of each set of chunks that an
// earlier order reached. If this order reaches the same set, its surface must be the same.
void refine_at_random(const StoredModel& model, Dice& dice,
                      std::map<std::vector<bool>, SurfaceFaces>& known) {
  Refiner refiner = start_refiner(model);
  std::vector<bool> applied(model.manifest.chunks.size(), false);
  for (std::size_t step = 0; step < applied.size(); ++step) {
    const auto ready = ready_chunks(refiner);
    ASSERT_FALSE(ready.empty());
    const std::size_t chunk = ready[dice.below(static_cast<std::uint32_t>(ready.size()))];
    apply_chunk(refiner, model, chunk);
    applied[chunk] = true;
    expect_manifold(refiner);
    SurfaceFaces surface = canonical_surface(refiner.lattice_mesh());
    const auto [before, is_new] = known.emplace(applied, surface);
    ASSERT_TRUE(is_new || before->second == surface) << "after chunk " << chunk;
  }
}

void expect_same_in_every_order(std::uint64_t seed) {
  const StoredModel model = random_model(seed);
  Dice dice(seed);
  std::map<std::vector<bool>, SurfaceFaces> known;
  for (std::uint32_t order = 0; order < kOrders; ++order) {
    refine_at_random(model, dice, known);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(RefinementOrder, ManyRandomModelsForkAndBringComponentsWhole) {
  std::uint32_t forked = 0, forked_again = 0, with_insertions = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Manifest manifest = random_model(seed).manifest;
    const RegionTree& tree = manifest.tree;
    with_insertions += std::ranges::any_of(manifest.chunks, [](const ChunkInfo& chunk) {
      return chunk.level > 1 && chunk.inserted > 0;
    });
    forked += tree.leaves() > 1 ? 1 : 0;
    forked_again += std::ranges::any_of(
        tree.nodes, [&](const RegionNode& node) { return node.fork > tree.nodes[0].fork; });
  }
  EXPECT_GE(forked, 20u);
  EXPECT_GE(forked_again, 10u) << "regions fork at several levels";
  EXPECT_GE(with_insertions, 10u);
}

TEST(RefinementOrder, TheSameChunksGiveTheSameMeshInEveryOrder) {
  const std::uint64_t count = seeds(200);
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_THROW(expect_same_in_every_order(seed));
    if (HasFatalFailure()) return;
  }
}

// Returns the surface with its positions rounded to cells of `level`. A chunk adds lower bits to
// the positions. Undoing the chunk does not clear these bits, but rounding does.
SurfaceFaces surface_in_cells(const Refiner& refiner, std::uint32_t level) {
  LatticeMesh mesh = refiner.lattice_mesh();
  for (Vec3i& p : mesh.positions)
    p = cell_of(p, refiner.manifest().levels[level].shift);
  return canonical_surface(mesh);
}

// Applies the first `chunks` chunks in file order. Then undoes a part of the last chunk, and then
// all of it. The surface must then be the same as before the last chunk.
void expect_undo(const StoredModel& model, Dice& dice, std::size_t chunks) {
  Refiner refiner = start_refiner(model);
  for (std::size_t i = 0; i + 1 < chunks; ++i)
    apply_chunk(refiner, model, i);
  const std::uint32_t level = model.manifest.chunks[chunks - 1].level - 1;
  const SurfaceFaces before = surface_in_cells(refiner, level);
  const std::uint32_t coarse = refiner.face_count();
  apply_chunk(refiner, model, chunks - 1);
  const std::uint32_t wanted = coarse + dice.below(refiner.face_count() - coarse + 1);
  refiner.undo_to_faces(wanted);
  ASSERT_LE(refiner.face_count(), wanted);
  // A split adds at most two faces. An inserted component adds at most two faces per vertex.
  const std::uint32_t most = model.manifest.chunks[chunks - 1].inserted > 0 ? 2 * kMostInserted : 2;
  ASSERT_GT(refiner.face_count() + most, wanted);
  expect_manifold(refiner);
  refiner.undo_to_faces(0);
  ASSERT_EQ(surface_in_cells(refiner, level), before);
}

void expect_chunks_undone(std::uint64_t seed) {
  const StoredModel model = random_model(seed);
  Dice dice(seed);
  const auto all = static_cast<std::uint32_t>(model.manifest.chunks.size());
  for (int i = 0; i < 8 && all > 0; ++i) {
    expect_undo(model, dice, 1 + dice.below(all));
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(RefinementOrder, AnyChunkCanBeShownInPartAndTakenBack) {
  const std::uint64_t count = 300;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_THROW(expect_chunks_undone(seed));
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace vitrine::test
