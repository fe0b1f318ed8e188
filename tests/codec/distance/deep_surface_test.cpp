// SPDX-License-Identifier: Apache-2.0
// Tests surfaces for which triangles must be cut thousands of times in turn, and surfaces with many
// copies of one triangle.
#include <gtest/gtest.h>
#include <pthread.h>

#include <functional>
#include <random>

#include "codec/distance/error_meter.h"
#include "codec/repair/triangulate.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

// Returns a polygon with `count` corners, cut into triangles. It is a strip with long teeth on both
// sides.
TriangleMesh comb(std::uint32_t count) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t half = count / 2, x = i < half ? i : count - 1 - i;
    const double tooth = x % 2 * 100.0;
    mesh.positions.push_back({static_cast<double>(x), i < half ? tooth : -5 - tooth, 0});
    corners.push_back(i);
  }
  triangulate(mesh.positions, corners, mesh.faces);
  return mesh;
}

// Returns a rectangle over a comb with `count` corners.
TriangleMesh rectangle(std::uint32_t count) {
  const double right = count / 2 - 1.0;
  return {.positions = {{0, -105, 1}, {right, -105, 0}, {right, 100, 1}, {0, 100, 0}},
          .faces = {{0, 1, 2}, {0, 2, 3}},
          .attributes = {}};
}

// Runs `work` in a thread whose stack has `bytes` bytes.
void run_with_stack(std::size_t bytes, const std::function<void()>& work) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, bytes), 0);
  pthread_t thread;
  const auto run = [](void* task) -> void* {
    (*static_cast<const std::function<void()>*>(task))();
    return nullptr;
  };
  auto task = work;
  ASSERT_EQ(pthread_create(&thread, &attributes, run, &task), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

TEST(DeepSurface, AThinStackSufficesForAnyNumberOfCuts) {
  constexpr std::uint32_t kCorners = 12'000;
  LevelError error;
  const ErrorMeter meter(comb(kCorners));
  run_with_stack(64 << 10, [&] { error = meter.measure(rectangle(kCorners)); });
  EXPECT_GT(error.cuts, 1'000u);
  EXPECT_GE(error.max_error, 40);  // corners of the rectangle lie between two teeth
}

// Returns `count` copies of one triangle, each with its own vertices.
TriangleMesh copies(std::uint32_t count) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    mesh.faces.push_back({3 * i + i % 3, 3 * i + (i + 1) % 3, 3 * i + (i + 2) % 3});
  }
  return mesh;
}

TEST(DeepSurface, AQueryLooksAtOneOfManyCopies) {
  TriangleMesh mesh = copies(10'000);
  mesh.positions.insert(mesh.positions.end(), {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}});
  mesh.faces.push_back({30'000, 30'001, 30'002});
  const TriangleBvh bvh(mesh);
  const ClosestTriangle copy = bvh.closest({0.7, 0.7, 0.1}), other = bvh.closest({3, 0, 1});
  EXPECT_LE(copy.visited, 32u);
  EXPECT_NEAR(copy.squared, 0.09, 1e-12);
  EXPECT_LE(other.visited, 32u);
  EXPECT_NEAR(other.squared, 1, 1e-12);
}

// Returns triangles between random points, most of which cross many others.
TriangleMesh tangle(std::uint32_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(0, 1);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back({at(random), at(random), 0.1 * at(random)});
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(DeepSurface, TheWorkForATangleIsBounded) {
  TriangleMesh some = tangle(2'000);
  const ErrorMeter meter(some);
  some.faces.resize(1'000);
  const LevelError error = meter.measure(some);
  EXPECT_LE(error.cuts, 4'000u);
  EXPECT_LE(error.max_error, 0.5);
}

}  // namespace
}  // namespace vitrine::test
