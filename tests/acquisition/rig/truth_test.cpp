// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "codec/import/read_mesh.h"
#include "support/rig_scenes.h"

namespace vitrine::acquisition::rig::test {
namespace {

std::vector<std::uint8_t> seen_of(const TriangleMesh& mesh, std::uint64_t seed = 1) {
  return seen_vertices(mesh, matt(mesh), optics_of(seed));
}

TEST(Truth, ABallOnTheAxisIsSeenButForItsCaps) {
  const TriangleMesh mesh = ball({0, 0, 40}, 30, 100);
  const auto seen = seen_of(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const double z = mesh.positions[v].z;
    if (std::abs(z - 40) < 20) {
      EXPECT_TRUE(seen[v]) << z;
    } else if (z < 12) {
      EXPECT_FALSE(seen[v]) << z;  // the lower part of the sphere faces the table
    }
  }
}

TEST(Truth, WhatIsInsideIsNotSeen) {
  TriangleMesh mesh = ball({0, 0, 40}, 30, 100);
  const std::size_t outer = mesh.positions.size();
  const TriangleMesh inner = ball({0, 0, 40}, 20, 40);
  for (const Triangle& face : inner.faces)
    mesh.faces.push_back({face[0] + static_cast<std::uint32_t>(outer),
                          face[1] + static_cast<std::uint32_t>(outer),
                          face[2] + static_cast<std::uint32_t>(outer)});
  mesh.positions.insert(mesh.positions.end(), inner.positions.begin(), inner.positions.end());
  const auto seen = seen_of(mesh);
  EXPECT_EQ(std::count(seen.begin() + static_cast<std::ptrdiff_t>(outer), seen.end(), 1), 0);
}

TEST(Truth, WhatTheLaserAloneSeesDoesNotCount) {
  // The laser lights the bottom of the groove. The camera is 27 degrees to the side, so it sees
  // only the side of the groove.
  TriangleMesh open = wall({20, 0, 40}, 0, 4), grooved = open;
  for (const double side : {-2.5, 2.5}) {
    add_quad(grooved, {20, side, 20}, {20, 0, 0}, {0, 0, 40});
  }
  add_quad(grooved, {19, -10, 10}, {0, 20, 0}, {0, 0, 60});  // blocks the view from behind
  EXPECT_EQ(seen_of(open), std::vector<std::uint8_t>(4, 1));
  const auto seen = seen_of(grooved);
  EXPECT_EQ(std::vector<std::uint8_t>(seen.begin(), seen.begin() + 4),
            std::vector<std::uint8_t>(4, 0));
}

TEST(Truth, SeenIsWhatShowsLightInAPicture) {
  const TriangleMesh mesh = ball({0, 0, 40}, 25, 12);
  const Solid solid = matt(mesh);
  const Optics optics = optics_of(1);
  Renderer renderer(optics, &solid, ideal());
  std::vector<std::uint8_t> lit(mesh.positions.size());
  const auto look = [&](double degrees) {
    const Frame frame = renderer.take({at(degrees, true)}),
                dark = renderer.take({at(degrees, false)});
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 p = turned(optics, degrees, mesh.positions[v]);
      if (std::abs(dot(optics.laser.normal, p) - optics.laser.offset) > 0.3) continue;
      const ImagePoint pixel = *project(optics.camera, p);
      const int row = static_cast<int>(std::lround(pixel.v)),
                u = static_cast<int>(std::lround(pixel.u));
      for (int i = u - 1; i <= u + 1; ++i)
        lit[v] |= frame.row(row)[i] > dark.row(row)[i] + 8;
    }
  };
  for (int meridian = 0; meridian < 12; ++meridian) {
    for (const double beside : {-0.75, 0.0, 0.75})
      look(30 * meridian + beside);
  }
  const auto seen = seen_vertices(mesh, solid, optics);
  int differing = 0;
  for (std::size_t v = 0; v < seen.size(); ++v)
    differing += seen[v] != lit[v];
  EXPECT_GT(std::count(seen.begin(), seen.end(), 1), 40);
  EXPECT_LE(differing, 4);  // the poles, and vertices with only one visible face, may differ
}

TEST(Truth, ThePlyHasTheMeshInMillimetresAndTheFlag) {
  const TriangleMesh mesh = wall({1, 2, 3}, 10, 5);
  const auto bytes = truth_ply(mesh, {1, 0, 1, 1});
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_NE(text.find("property uchar seen\n"), std::string_view::npos);
  const auto back = read_mesh(bytes);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->unit, "mm");
  EXPECT_EQ(back->mesh.positions, mesh.positions);
  EXPECT_EQ(back->mesh.faces, mesh.faces);
  const std::size_t header = text.find("end_header\n") + 11;
  EXPECT_EQ(bytes[header + 24], 1);
  EXPECT_EQ(bytes[header + 25 + 24], 0);
}

}  // namespace
}  // namespace vitrine::acquisition::rig::test
