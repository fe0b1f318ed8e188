// SPDX-License-Identifier: Apache-2.0
// Tests that random meshes are decoded exactly as they were encoded.
#include <gtest/gtest.h>

#include "support/product_names.h"
#include "support/random_mesh.h"
#include "support/seeds.h"
#include "support/stored_model.h"

namespace vitrine::test {
namespace {

// Returns random options with a small base mesh and small regions. Even small meshes then have
// several levels, and often several regions.
SimplifyOptions random_options(Dice& dice) {
  return {.placement = dice.one_in(2) ? Placement::kPyramid : Placement::kMidpoint,
          .order = dice.one_in(4) ? CollapseOrder::kHeap : CollapseOrder::kBatch,
          .target_vertices = 4 + dice.below(20),
          .region_vertices = dice.one_in(2) ? 0 : 8 + dice.below(40)};
}

void expect_counts(const Refiner& refiner, std::uint32_t level) {
  const LevelInfo& stated = refiner.manifest().levels[level];
  ASSERT_EQ(refiner.vertex_count(), stated.vertices);
  ASSERT_EQ(refiner.face_count(), stated.faces);
}

void expect_round_trip(std::uint64_t seed) {
  LatticeMesh fine = random_mesh(seed);
  Dice dice(~seed);
  if (dice.one_in(3)) add_specks(fine, dice.below(40), seed);
  const StoredModel model = store_model(fine, random_options(dice));
  Refiner refiner = start_refiner(model);
  expect_counts(refiner, 0);
  for (std::size_t i = 0; i < model.manifest.chunks.size(); ++i)
    apply_chunk(refiner, model, i);
  expect_counts(refiner, static_cast<std::uint32_t>(model.manifest.levels.size() - 1));
  ASSERT_EQ(canonical_surface(refiner.lattice_mesh()), canonical_surface(fine));
}

TEST(RoundTrip, RandomMeshesComeBackExactly) {
  const std::uint64_t count = seeds(10'000);
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_THROW(expect_round_trip(seed));
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace vitrine::test
