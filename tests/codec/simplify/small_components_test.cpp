// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/small_components.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "codec/simplify/simplify.h"
#include "support/hierarchies.h"
#include "support/meshes.h"
#include "support/random_mesh.h"

namespace vitrine::test {
namespace {

std::int32_t width(const std::vector<Vec3i>& positions) {
  const auto by_x = [](const Vec3i& a, const Vec3i& b) { return a.x < b.x; };
  const auto [low, high] = std::ranges::minmax_element(positions, by_x);
  return high->x - low->x;
}

TEST(SmallComponents, OfAModelOfSpecksAloneTheLargestAreTheBase) {
  LatticeMesh specks{.lattice = {.bits = 12}, .positions = {}, .faces = {}, .attributes = {}};
  add_specks(specks, 3000, 2);
  const auto hierarchy = simplify(specks, {});
  ASSERT_TRUE(hierarchy.has_value());
  EXPECT_GE(hierarchy->base.positions.size(), 150u);
  EXPECT_LE(hierarchy->base.positions.size(), 375u);
  ASSERT_FALSE(hierarchy->insertions[0].empty());
  for (const Component& component : hierarchy->insertions[0])
    EXPECT_LE(width(component.mesh.positions), width(hierarchy->base.positions));
}

// The smallest torus has seven vertices, all adjacent to each other. Like every torus, it has two
// faces per vertex, the largest number allowed for an inserted component.
TEST(SmallComponents, TheSmallestTorusIsBornWhole) {
  LatticeMesh mesh = on_lattice(sheet(30, 30));
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::int32_t k = 0; k < 7; ++k)
    mesh.positions.push_back({100 + k, 5 * k % 7, 3 * k % 7});
  for (std::uint32_t k = 0; k < 7; ++k) {
    mesh.faces.push_back({first + k, first + (k + 1) % 7, first + (k + 3) % 7});
    mesh.faces.push_back({first + k, first + (k + 3) % 7, first + (k + 2) % 7});
  }
  const auto hierarchy = simplify(mesh, {.target_vertices = 60});
  ASSERT_TRUE(hierarchy.has_value());
  EXPECT_EQ(inserted_vertices(*hierarchy), 7u);
}

TEST(SmallComponents, WhatIsAsLargeAsTheModelStays) {
  LatticeMesh mesh = on_lattice(torus(40, 24));
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto faces = mesh.faces;
  for (std::uint32_t v = 0; v < first; ++v)
    mesh.positions.push_back(
        {4095 - mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z});
  for (const Triangle& f : faces)
    mesh.faces.push_back({first + f[0], first + f[2], first + f[1]});
  const auto hierarchy = simplify(mesh, {});
  ASSERT_TRUE(hierarchy.has_value());
  EXPECT_EQ(inserted_vertices(*hierarchy), 0u);
}

}  // namespace
}  // namespace vitrine::test
