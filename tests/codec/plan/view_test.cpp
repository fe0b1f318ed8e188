// SPDX-License-Identifier: Apache-2.0
// Checks that a camera gets all chunks that it needs, but fewer than the whole model, and that
// another camera gets other chunks.
#include "codec/plan/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "codec/build/refine.h"
#include "support/meshes.h"
#include "support/stored_model.h"

namespace vitrine {
namespace {

using test::StoredModel;
using Chunks = std::vector<std::size_t>;

// Returns a torus with many regions. Each level has half the error of the previous one.
const StoredModel& torus_of_regions() {
  static const StoredModel model = [] {
    const TriangleMesh torus = test::torus(300, 150);
    StoredModel made = test::store_model(quantise(torus, fit_lattice(torus.positions, 12)),
                                         {.target_vertices = 60, .region_vertices = 900});
    double error = 1;
    for (LevelInfo& level : made.manifest.levels)
      level.max_error = error, error /= 2;
    made.manifest.levels.back().max_error = 0;
    for (ChunkInfo& chunk : made.manifest.chunks)
      chunk.max_error = made.manifest.levels[chunk.level].max_error;
    return made;
  }();
  return model;
}

struct ModelExtent {
  Vec3 centre, size;
};
ModelExtent extent_of(const Manifest& m) {
  const LatticeBox& box = m.tree.nodes[0].box;
  const Vec3 low = m.lattice.to_model(box.low), high = m.lattice.to_model(box.high);
  return {(low + high) * 0.5, high - low};
}

// Returns a view along +x (if `sense` is 1) or -x (if `sense` is -1). The camera looks at the
// middle of the model's near side from `distance` away.
View along_x(const Manifest& m, double sense, double distance) {
  const ModelExtent extent = extent_of(m);
  const double x = extent.centre.x - sense * (extent.size.x / 2 + distance);
  const double right = sense;  // y points up, so right is +z or -z
  return {.camera = {0, 0, right, 0, 0, 1, 0, 0, -sense, 0, 0, 0, x, extent.centre.y,
                     extent.centre.z, 1},
          .field_of_view = 30,
          .width = 800,
          .height = 600};
}

Chunks plan(const Manifest& manifest, const View& view) {
  Planner planner(manifest);
  planner.want(view);
  Chunks chunks;
  while (const auto chunk = planner.next()) {
    planner.have(*chunk);
    chunks.push_back(*chunk);
  }
  return chunks;
}

std::uint64_t bytes_of(const Manifest& manifest, const Chunks& chunks) {
  std::uint64_t bytes = manifest.head_bytes();
  for (const std::size_t chunk : chunks)
    bytes += manifest.chunks[chunk].length;
  return bytes;
}

TEST(View, ACloseUpWhereErrorsHalveByLevelNeedsAThirdOfTheBytes) {
  const Manifest& m = torus_of_regions().manifest;
  const Chunks chunks = plan(m, along_x(m, 1, extent_of(m).size.x / 16));
  EXPECT_GT(chunks.size(), m.levels.size());
  EXPECT_LT(bytes_of(m, chunks), m.file_bytes / 3);
}

TEST(View, OppositeCamerasGetDifferentBytesInAnotherOrder) {
  const Manifest& m = torus_of_regions().manifest;
  Chunks here = plan(m, along_x(m, 1, extent_of(m).size.x / 16));
  Chunks there = plan(m, along_x(m, -1, extent_of(m).size.x / 16));
  EXPECT_NE(here, there);
  std::ranges::sort(here);
  std::ranges::sort(there);
  Chunks only_here;
  std::ranges::set_difference(here, there, std::back_inserter(only_here));
  EXPECT_GT(only_here.size(), here.size() / 4);
}

TEST(View, EveryChunkCanBeAppliedWhenItsTurnComes) {
  const StoredModel& model = torus_of_regions();
  for (const double sense : {1.0, -1.0}) {
    Refiner refiner = test::start_refiner(model);
    for (const std::size_t chunk :
         plan(model.manifest,
              along_x(model.manifest, sense, extent_of(model.manifest).size.x / 16))) {
      ASSERT_TRUE(refiner.is_ready(chunk));
      test::apply_chunk(refiner, model, chunk);
    }
    const LatticeMesh mesh = refiner.lattice_mesh();
    EXPECT_TRUE(Connectivity::close(refiner.vertex_count(), mesh.faces)) << "a crack";
  }
}

TEST(View, NoErrorInSightIsAboveOnePixel) {
  const StoredModel& model = torus_of_regions();
  const Manifest& m = model.manifest;
  for (const double distance : {0.1, 1.0, 10.0}) {
    const View view = along_x(m, 1, distance * extent_of(m).size.x);
    Planner planner(m);
    planner.want(view);
    std::vector<bool> have(m.chunks.size());
    while (const auto chunk = planner.next())
      planner.have(*chunk), have[*chunk] = true;
    for (std::size_t i = 0; i < have.size(); ++i) {
      const ChunkInfo& chunk = m.chunks[i];
      const double before = m.levels[chunk.level - 1].max_error;
      const double pixels = pixels_of(before, m.region(chunk).box, m.lattice, view);
      EXPECT_TRUE(have[i] || pixels <= 1) << "chunk " << i << ": " << pixels;
    }
  }
}

// Returns the distance of a point from the eye along the viewing direction, or infinity if the view
// does not show the point.
double depth_in_sight(const Vec3& p, const View& view) {
  const auto axis = [&](std::size_t k) {
    return Vec3{view.camera[4 * k], view.camera[4 * k + 1], view.camera[4 * k + 2]};
  };
  const Vec3 d = p - axis(3);
  const double depth = -dot(d, axis(2));
  const double y = depth * std::tan(view.field_of_view / 2 * std::numbers::pi / 180);
  const bool seen = depth > 0 && std::abs(dot(d, axis(1))) <= y &&
                    std::abs(dot(d, axis(0))) <= y * view.width / view.height;
  return seen ? depth : std::numeric_limits<double>::infinity();
}

// Takes a grid of points in the box. Returns the smallest depth_in_sight() of these points.
double least_depth(const LatticeBox& box, const View& view) {
  constexpr int kSteps = 40;
  const Vec3 low = to_vec3(box.low), size = to_vec3(box.high) - low;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const Vec3 p{size.x * i / kSteps, size.y * j / kSteps, size.z * k / kSteps};
        least = std::min(least, depth_in_sight(low + p, view));
      }
    }
  }
  return least;
}

TEST(View, ABoxIsAsNearAsWhatIsInSightOfIt) {
  constexpr double kSmall = 1e-6;
  std::mt19937 random(5);
  const auto number = [&](int most) { return static_cast<std::int32_t>(random() % most); };
  int seen = 0, beside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3i low{number(60), number(60), number(60)};
    const LatticeBox box{low, low + Vec3i{1 + number(60), 1 + number(60), 1 + number(60)}};
    View view = along_x(torus_of_regions().manifest, 1, 1);
    view.camera[12] = -number(60), view.camera[13] = number(90), view.camera[14] = number(90);
    view.field_of_view = 20 + number(100);
    const double pixels = pixels_of(kSmall, box, {}, view), sampled = least_depth(box, view);
    const double slope = std::tan(view.field_of_view / 2 * std::numbers::pi / 180);
    const double depth = kSmall / pixels * view.height / (2 * slope);
    EXPECT_LE(depth, sampled * (1 + kSmall)) << i;
    // Skips boxes next to the eye, and boxes without a visible grid point.
    if (depth < 2 || sampled > 1e9) continue;
    EXPECT_GT(depth, sampled - 6) << i;  // 6 is four steps of the coarsest grid
    ++seen;
    // Counts boxes whose visible part begins well behind the side nearest to the camera.
    beside += sampled > low.x - view.camera[12] + 10 ? 1 : 0;
  }
  EXPECT_GT(seen, 100);
  EXPECT_GT(beside, 20);
}

TEST(View, FromAfarTheBaseIsEnough) {
  const Manifest& m = torus_of_regions().manifest;
  EXPECT_EQ(plan(m, along_x(m, 1, 1e6 * extent_of(m).size.x)), Chunks{});
}

TEST(View, WhatIsBehindTheCameraIsNotSent) {
  const Manifest& m = torus_of_regions().manifest;
  View view = along_x(m, 1, extent_of(m).size.x);
  for (const std::size_t k : {0, 1, 2, 8, 9, 10})
    view.camera[k] = -view.camera[k];
  EXPECT_EQ(plan(m, view), Chunks{});
}

TEST(View, ABudgetIsNeverExceeded) {
  const Manifest& m = torus_of_regions().manifest;
  View view = along_x(m, 1, extent_of(m).size.x / 16);
  const std::uint64_t all = bytes_of(m, plan(m, view)), layers = all - m.head_bytes();
  for (const std::uint64_t budget : {all - layers / 2, all - layers / 4, all - 1}) {
    view.bytes = static_cast<double>(budget);
    const Chunks chunks = plan(m, view);
    EXPECT_LE(bytes_of(m, chunks), budget);
    EXPECT_FALSE(chunks.empty());
  }
}

// Returns a manifest of 4 MB in which every region is adjacent to all other regions. If `behind` is
// true, half of the regions lie behind a camera that looks along x.
Manifest crowded_header(std::uint32_t regions, bool behind) {
  Manifest m;
  for (int level = 0; level < 40; ++level)
    m.levels.push_back({.vertices = 4, .faces = 4, .max_error = 1.0 / (level + 1)});
  const LatticeBox seen{{0, 0, 0}, {10, 10, 10}}, unseen{{-2'000, 0, 0}, {-1'990, 10, 10}};
  m.tree.nodes.clear();
  for (std::uint32_t k = 0; k < regions; ++k) {
    if (k + 1 < regions) m.tree.nodes.push_back({.fork = 2, .box = seen});
    m.tree.nodes.push_back({.box = behind && k >= regions / 2 ? unseen : seen});
    std::vector<std::uint32_t>& others = m.adjacency.emplace_back(regions);
    std::iota(others.begin(), others.end(), 0u);
    others.erase(others.begin() + k);
  }
  EXPECT_TRUE(m.tree.link());
  m.adjacency.erase(m.adjacency.begin());
  for (std::uint32_t level = 1; level < m.levels.size(); ++level) {
    for (const std::uint32_t node : m.tree.regions_at(level))
      m.chunks.push_back({.level = level,
                          .region = m.tree.nodes[node].first,
                          .node = node,
                          .max_error = m.levels[level].max_error});
  }
  return m;
}

// Plans only one chunk. A whole plan would take minutes, because half of the regions depend on the
// other half.
TEST(View, AHostileHeaderIsPlannedInBoundedSteps) {
  constexpr std::uint32_t kRegions = 2'000;
  for (const bool behind : {false, true}) {
    const Manifest m = crowded_header(kRegions, behind);
    Planner planner(m);
    planner.want(along_x(m, 1, 5));
    for (std::size_t i = 0; i < m.chunks.size(); ++i) {
      const ChunkInfo& chunk = m.chunks[i];
      if (chunk.level < 39 && chunk.region < kRegions / 2) planner.have(i);
    }
    EXPECT_EQ(planner.next(), std::optional(m.find_chunk(2, kRegions / 2))) << behind;
  }
}

TEST(View, ImpossibleCamerasAreTold) {
  const View good = along_x(torus_of_regions().manifest, 1, 1);
  EXPECT_TRUE(is_sane(good));
  const auto bad = [&](auto change) {
    View view = good;
    change(view);
    return !is_sane(view);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(bad([&](View& v) { v.camera[5] = nan; }));
  EXPECT_TRUE(bad([](View& v) { v.camera[8] = v.camera[9] = v.camera[10] = 0; }));
  EXPECT_TRUE(bad([](View& v) { v.field_of_view = 180; }));
  EXPECT_TRUE(bad([](View& v) { v.height = 0; }));
  EXPECT_TRUE(bad([](View& v) { v.pixel_error = 0; }));
  EXPECT_TRUE(bad([&](View& v) { v.bytes = nan; }));
}

}  // namespace
}  // namespace vitrine
