// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <set>

#include "codec/import/mesh_builders.h"
#include "codec/mesh/connectivity.h"
#include "codec/repair/repairing.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using vitrine::testing::append;
using vitrine::testing::grid;
using vitrine::testing::repaired;
using vitrine::testing::tetrahedron;

using Corners = std::array<std::array<double, 3>, 3>;
// Returns the faces as triples of positions, in sorted order. Each face is rotated to start at its
// smallest corner. If `unoriented` is true, a face and its reverse give the same result.
std::vector<Corners> surface(const TriangleMesh& mesh, bool unoriented) {
  std::vector<Corners> faces;
  for (const Triangle& face : mesh.faces) {
    Corners corners;
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh.positions[face[k]];
      corners[k] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    if (unoriented && corners[2] < corners[1]) std::swap(corners[1], corners[2]);
    faces.push_back(corners);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

TEST(Repair, LeavesAClosedManifoldAlone) {
  const auto result = repaired(tetrahedron());
  EXPECT_EQ(result.mesh.faces, tetrahedron().faces);
  EXPECT_EQ(result.mesh.positions, tetrahedron().positions);
  EXPECT_THAT(result.repairs, IsEmpty());
  EXPECT_EQ(result.boundary_edges, 0u);
  EXPECT_EQ(result.components, 1u);
}

TEST(Repair, AnOpenSheetIsNormalInputAndItsBoundaryIsCounted) {
  const auto result = repaired(grid(4));
  EXPECT_THAT(result.repairs, IsEmpty());
  EXPECT_EQ(result.boundary_edges, 16u);
}

TEST(Repair, CountsComponents) {
  TriangleMesh mesh = tetrahedron();
  append(mesh, grid(2));
  append(mesh, tetrahedron());
  EXPECT_EQ(repaired(mesh).components, 3u);
}

TEST(Repair, ATouchingVertexIsSplitBetweenItsFans) {
  TriangleMesh mesh = tetrahedron();
  mesh.positions.insert(mesh.positions.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  mesh.faces.insert(mesh.faces.end(), {{0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {5, 6, 0}});
  const auto result = repaired(mesh);
  EXPECT_EQ(result.mesh.positions.size(), 8u);
  EXPECT_EQ(result.boundary_edges, 0u);
  EXPECT_EQ(result.components, 2u);
  EXPECT_THAT(result.repairs,
              ElementsAre(HasSubstr("1 vertex split to part fans, first at vertex 0; ")));
  EXPECT_EQ(surface(result.mesh, false), surface(mesh, false));
}

TEST(Repair, SolidsThatTouchAtAnEdgePartAndStayClosed) {
  TriangleMesh mesh = tetrahedron();  // the mirror image added below shares the edge 0-3 with it
  mesh.positions.insert(mesh.positions.end(), {{-1, 0, 0}, {0, -1, 0}});
  mesh.faces.insert(mesh.faces.end(), {{0, 5, 4}, {0, 4, 3}, {4, 5, 3}, {5, 0, 3}});
  const auto result = repaired(mesh);
  EXPECT_EQ(result.boundary_edges, 0u);
  EXPECT_EQ(result.components, 2u);
  EXPECT_EQ(result.mesh.positions.size(), 8u);
  EXPECT_THAT(result.repairs, Contains(HasSubstr("1 non-manifold edge split, first at face 1; ")));
}

TEST(Repair, AThirdSheetAtAnEdgeKeepsAllItsFaces) {
  TriangleMesh mesh = grid(2);  // the face added below is the third one at the edge 4-5
  mesh.positions.push_back({1.5, 1, 1});
  mesh.faces.push_back({4, 5, 9});
  const auto result = repaired(mesh);
  EXPECT_EQ(surface(result.mesh, true), surface(mesh, true));
  EXPECT_EQ(result.mesh.faces.size(), 9u);
}

TEST(Repair, ExactDuplicatesAreDroppedWhateverTheirFirstCorner) {
  TriangleMesh mesh = tetrahedron();
  mesh.faces.insert(mesh.faces.end(), {{1, 3, 0}, {2, 1, 0}});
  const auto result = repaired(mesh);
  EXPECT_EQ(result.mesh.faces, tetrahedron().faces);
  EXPECT_THAT(
      result.repairs,
      ElementsAre("2 duplicate faces dropped, first at face 4; remove such parts in the source"));
}

TEST(Repair, AThinSheetBecomesTwoWholeSheets) {
  TriangleMesh mesh = grid(3);
  for (std::size_t f = 0; f < 18; ++f) {
    const auto [a, b, c] = mesh.faces[f];
    mesh.faces.push_back({a, c, b});
  }
  const auto result = repaired(mesh);
  EXPECT_EQ(result.mesh.faces.size(), 36u);
  EXPECT_EQ(result.components, 2u);
  EXPECT_EQ(result.mesh.positions.size(), 32u);
  EXPECT_EQ(result.boundary_edges, 24u);
  EXPECT_EQ(surface(result.mesh, false), surface(mesh, false));
  EXPECT_THAT(result.repairs, Contains(HasSubstr("18 opposed faces on the same vertices parted")));
}

TEST(Repair, TheMinorityIsReversed) {
  TriangleMesh mesh = grid(3);
  std::swap(mesh.faces[5][1], mesh.faces[5][2]);
  std::swap(mesh.faces[9][0], mesh.faces[9][2]);
  const auto result = repaired(mesh);
  EXPECT_EQ(surface(result.mesh, false), surface(grid(3), false));
  EXPECT_THAT(
      result.repairs,
      ElementsAre(HasSubstr("2 faces reversed to agree with neighbours, first at face 5; ")));
}

TEST(Repair, AMoebiusBandIsCutOnce) {
  TriangleMesh mesh;
  const std::uint32_t n = 12;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double turn = 3.14159265358979 * i / n;
    const Vec3 mid{3 * std::cos(2 * turn), 3 * std::sin(2 * turn), 0};
    const Vec3 arm{std::cos(turn) * mid.x / 3, std::cos(turn) * mid.y / 3, std::sin(turn)};
    mesh.positions.push_back(mid + arm);
    mesh.positions.push_back(mid - arm);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    std::uint32_t a = 2 * i, b = a + 1, c = a + 2, d = a + 3;
    if (i + 1 == n) c = 1, d = 0;
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({b, d, c});
  }
  const auto result = repaired(mesh);
  EXPECT_EQ(surface(result.mesh, true), surface(mesh, true));
  EXPECT_EQ(result.components, 1u);
  EXPECT_EQ(result.mesh.positions.size(), 2 * n + 2);
  EXPECT_THAT(result.repairs,
              Contains(HasSubstr("1 edge cut where the surface has only one side")));
}

TEST(Repair, DegenerateFacesAndUnreferencedVerticesAreDroppedAndZeroAreaFacesStay) {
  TriangleMesh mesh = tetrahedron();
  mesh.positions[3] = mesh.positions[0];
  mesh.positions.push_back({9, 9, 9});
  mesh.faces.insert(mesh.faces.begin(), {2, 2, 1});
  const auto result = repaired(mesh);
  EXPECT_EQ(result.mesh.faces, tetrahedron().faces);
  EXPECT_THAT(result.repairs, ElementsAre(HasSubstr("1 degenerate face dropped, first at face 0; "),
                                          HasSubstr("1 unreferenced vertex dropped; ")));
}

TEST(Repair, ColoursFollowTheirVertices) {
  TriangleMesh mesh = tetrahedron();
  mesh.positions.insert(mesh.positions.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  mesh.faces.insert(mesh.faces.end(), {{0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {5, 6, 0}});
  for (std::uint8_t v = 0; v < 7; ++v)
    mesh.attributes.colours.push_back({v, 10, 20});
  const auto result = repaired(mesh);
  ASSERT_EQ(result.mesh.attributes.colours.size(), 8u);
  EXPECT_EQ(result.mesh.attributes.colours[7], (Colour{0, 10, 20}));
}

TEST(Repair, AnIndexOutOfRangeIsRefusedByName) {
  TriangleMesh mesh = tetrahedron();
  mesh.faces[2][1] = 4;
  const auto result = repair({mesh, {}});
  ASSERT_FALSE(result.has_value());
  EXPECT_THAT(result.error().message, HasSubstr("face 2"));
}

TEST(Repair, AMeshWithoutAnyAreaIsRefusedInPlainWords) {
  const std::vector<TriangleMesh> meshes = {
      {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .faces = {{0, 0, 1}, {2, 2, 2}}},
      {.positions = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, .faces = {{0, 1, 2}}},
      {.positions = {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}, .faces = {{0, 1, 2}}}};
  for (const TriangleMesh& mesh : meshes) {
    const auto result = repair({mesh, {}});
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().message,
              "no face of the mesh has an area: the corners of each lie in one point or on one "
              "line; export the surface again");
  }
}

TEST(Repair, TheSampleScanNeedsNone) {
  std::ifstream file(VITRINE_SOURCE_DIR "/tests/models/demosthenes.obj", std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  auto read = read_mesh({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  const auto result = repaired(read->mesh);
  EXPECT_EQ(result.mesh.positions.size(), 8394u);
  EXPECT_EQ(result.mesh.faces.size(), 16719u);
  EXPECT_EQ(result.components, 1u);
  EXPECT_THAT(result.repairs, IsEmpty());
}

// Returns the number of faces that repair must keep. Repair removes only degenerate faces and exact
// duplicates.
std::size_t expected_faces(const TriangleMesh& mesh) {
  std::set<Triangle> distinct;
  for (Triangle face : mesh.faces) {
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    distinct.insert(face);
  }
  return distinct.size();
}

bool has_area(const TriangleMesh& mesh) {
  return std::ranges::any_of(mesh.faces, [&](const Triangle& face) {
    const auto& [a, b, c] = face;
    const std::vector<Vec3>& p = mesh.positions;
    return length(cross(p[b] - p[a], p[c] - p[a])) > 0;
  });
}

TEST(Repair, AnySoupOfTrianglesBecomesManifoldAndKeepsEveryFace) {
  for (std::uint32_t seed = 0; seed < 20'000; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random()) % n; };
    TriangleMesh mesh;
    const std::uint32_t vertices = 3 + below(12), faces = 1 + below(40);
    for (std::uint32_t v = 0; v < vertices; ++v) {
      mesh.positions.push_back({1.0 * below(5), 1.0 * below(5), 1.0 * below(5)});
    }
    for (std::uint32_t f = 0; f < faces; ++f) {
      mesh.faces.push_back({below(vertices), below(vertices), below(vertices)});
    }
    const std::size_t expected = expected_faces(mesh);
    const auto result = repair({mesh, {}});
    if (!has_area(mesh)) {
      ASSERT_FALSE(result.has_value());
      continue;
    }
    ASSERT_TRUE(result.has_value()) << result.error().message << " seed " << seed;
    ASSERT_EQ(result->mesh.faces.size(), expected) << "seed " << seed;
    const auto closed = Connectivity::close(
        static_cast<std::uint32_t>(result->mesh.positions.size()), result->mesh.faces);
    ASSERT_TRUE(closed.has_value()) << closed.error().message << " seed " << seed;
    std::uint64_t border = 0;
    for (std::uint32_t l = 0; l < closed->loop_count(); ++l) {
      border += closed->loop_length(kVirtualBit + l);
    }
    ASSERT_EQ(result->boundary_edges, border) << "seed " << seed;
  }
}

}  // namespace
}  // namespace vitrine
