// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/order_in_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <vector>

#include "support/meshes.h"

namespace vitrine::test {
namespace {

// Returns the same mesh with its vertices and faces in random order.
TriangleMesh shuffled(const TriangleMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> name(mesh.positions.size());
  std::iota(name.begin(), name.end(), 0u);
  std::shuffle(name.begin(), name.end(), random);
  TriangleMesh out = mesh;
  for (std::size_t v = 0; v < name.size(); ++v) {
    out.positions[name[v]] = mesh.positions[v];
    if (!mesh.attributes.colours.empty())
      out.attributes.colours[name[v]] = mesh.attributes.colours[v];
  }
  for (Triangle& f : out.faces)
    f = {name[f[0]], name[f[1]], name[f[2]]};
  std::shuffle(out.faces.begin(), out.faces.end(), random);
  return out;
}

// Returns the faces in sorted order. Each face consists of its corners' positions and colours,
// starting at the smallest corner.
std::vector<std::array<double, 12>> content(const TriangleMesh& mesh) {
  std::vector<std::array<double, 12>> faces;
  for (const Triangle& f : mesh.faces) {
    std::array<std::array<double, 4>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.positions[f[k]];
      corners[k] = {p.x, p.y, p.z,
                    mesh.attributes.colours.empty() ? 0.0 : mesh.attributes.colours[f[k]][0]};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<double, 12>& face = faces.emplace_back();
    for (std::size_t k = 0; k < 12; ++k)
      face[k] = corners[k / 4][k % 4];
  }
  std::ranges::sort(faces);
  return faces;
}

double mean_step(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& f : mesh.faces)
    sum += std::max({f[0], f[1], f[2]}) - std::min({f[0], f[1], f[2]});
  return sum / static_cast<double>(mesh.faces.size());
}

TEST(OrderInSpace, KeepsFacesTheirSidesAndColours) {
  TriangleMesh mesh = sheet(30, 40);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.attributes.colours.push_back({static_cast<std::uint8_t>(v % 251), 0, 0});
  TriangleMesh ordered = shuffled(mesh, 1);
  order_in_space(ordered);
  EXPECT_EQ(content(ordered), content(mesh));
}

TEST(OrderInSpace, NeighboursComeNearEachOther) {
  TriangleMesh mesh = shuffled(sheet(60, 60), 2);
  const double before = mean_step(mesh);
  order_in_space(mesh);
  EXPECT_LT(mean_step(mesh), before / 10);
}

TEST(OrderInSpace, FacesFollowTheirVertices) {
  TriangleMesh mesh = shuffled(sheet(20, 20), 3);
  order_in_space(mesh);
  EXPECT_TRUE(std::ranges::is_sorted(mesh.faces, {}, [](const Triangle& f) {
    return std::min({f[0], f[1], f[2]});
  }));
}

TEST(OrderInSpace, CopesWithPointsThatCoincideAndWithNone) {
  TriangleMesh none;
  order_in_space(none);
  EXPECT_TRUE(none.positions.empty());
  TriangleMesh point{.positions = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, .faces = {{2, 0, 1}}};
  order_in_space(point);
  EXPECT_EQ(point.faces, (std::vector<Triangle>{{2, 0, 1}}));
}

}  // namespace
}  // namespace vitrine::test
