// SPDX-License-Identifier: Apache-2.0
// Tests that the number of threads does not change a model.
#include <gtest/gtest.h>

#include "support/product_names.h"
#include "support/random_mesh.h"
#include "support/seeds.h"
#include "support/stored_model.h"

namespace vitrine::test {
namespace {

SimplifyOptions options_for_threads(Dice& dice) {
  return {.placement = dice.one_in(3) ? Placement::kPyramid : Placement::kMidpoint,
          .target_vertices = 4 + dice.below(60),
          .region_vertices = dice.one_in(3) ? 0 : 40 + dice.below(400)};
}

TEST(Threads, RandomMeshesGiveTheSameModelForAnyNumber) {
  const std::uint64_t count = seeds(200);
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(~seed);
    const LatticeMesh fine = random_mesh(seed, 120 + dice.below(2000));
    SimplifyOptions options = options_for_threads(dice);
    const auto one = store_model(fine, options).file;
    for (options.threads = 2; options.threads <= 3; ++options.threads)
      ASSERT_EQ(store_model(fine, options).file, one) << options.threads << " threads";
  }
}

}  // namespace
}  // namespace vitrine::test
