// SPDX-License-Identifier: Apache-2.0
// The errors that a file states hold while some regions are finer than others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "codec/mesh/triangle_bvh.h"
#include "server/jobs/build_model.h"
#include "server/jobs/open_model.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

std::vector<std::size_t> ready_chunks(const Refiner& refiner) {
  std::vector<std::size_t> ready;
  for (std::size_t i = 0; i < refiner.manifest().chunks.size(); ++i) {
    if (refiner.ready(i)) ready.push_back(i);
  }
  return ready;
}

// What is stated for the faces at v.
double stated_error(const Refiner& refiner, VertexId v) {
  const Manifest& m = refiner.manifest();
  const std::size_t chunk = m.find_chunk(refiner.level_of(v), refiner.region_of(v));
  return chunk < m.chunks.size() ? m.chunks[chunk].max_error : m.levels[0].max_error;
}

// The number of faces between regions of different levels.
std::size_t expect_true_errors(const Refiner& refiner, const TriangleBvh& original) {
  const TriangleMesh shown = refiner.display_mesh();
  std::size_t mixed = 0;
  for (const Triangle& f : shown.faces) {
    const auto [fine, coarse] = std::minmax(
        {refiner.level_of(f[0]), refiner.level_of(f[1]), refiner.level_of(f[2])}, std::greater<>());
    if (fine == coarse) continue;
    ++mixed;
    double error = 0;
    for (const VertexId v : f)
      error = std::max(error, refiner.level_of(v) == coarse ? stated_error(refiner, v) : 0);
    const Vec3 &a = shown.positions[f[0]], &b = shown.positions[f[1]], &c = shown.positions[f[2]];
    for (const Vec3& p :
         {a, b, c, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5, (a + b + c) * (1.0 / 3)}) {
      EXPECT_LE(std::sqrt(original.closest(p).squared), error * (1 + 1e-9));
    }
  }
  return mixed;
}

TEST(MixedLevels, ShowNothingFartherOffThanTheCoarserRegionStates) {
  const auto input = file_bytes(VITRINE_SOURCE_DIR "/tests/models/demosthenes.obj");
  const auto built = build_model(input, {.bits = 16, .region_vertices = 500}, {});
  ASSERT_TRUE(built);
  const TriangleBvh original(shipped_model("demosthenes.obj"));
  auto refiner = open_model(built->file);
  ASSERT_TRUE(refiner);
  ASSERT_GT(refiner->manifest().tree.leaves(), 8u);
  const ChunkReader read = chunks_of(refiner->manifest(), built->file);
  std::mt19937 random(1);
  std::size_t mixed = 0;
  for (auto ready = ready_chunks(*refiner); !ready.empty(); ready = ready_chunks(*refiner)) {
    const std::size_t chunk = ready[random() % ready.size()];
    ASSERT_TRUE(refiner->apply(chunk, *read(chunk)));
    mixed += expect_true_errors(*refiner, original);
  }
  EXPECT_GT(mixed, 1000u);
}

}  // namespace
}  // namespace vitrine::test
