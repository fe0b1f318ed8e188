// SPDX-License-Identifier: Apache-2.0
// Tests the repair of files that repeat vertices along seams but do not mark the seams.
#include <algorithm>
#include <random>

#include "codec/import/reading.h"
#include "codec/repair/repairing.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using vitrine::testing::read_text;
using vitrine::testing::repaired;

RepairedMesh built(std::string_view text) {
  return repaired(read_text(text));
}

// A tetrahedron as OBJ. Its two halves have separate vertices.
constexpr char kHalves[] =
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\n"
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\n"
    "f 1 3 2\nf 1 2 4\nf 6 7 8\nf 5 8 7\n";

TEST(Seams, AnObjWithoutNormalsOrTexturesIsClosed) {
  const auto result = built(kHalves);
  EXPECT_EQ(result.boundary_edges, 0u);
  EXPECT_EQ(result.components, 1u);
  EXPECT_EQ(result.mesh.positions.size(), 4u);
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 2, 1}, Triangle{0, 1, 3},
                                             Triangle{1, 2, 3}, Triangle{0, 3, 2}));
  EXPECT_THAT(result.repairs,
              ElementsAre("4 repeated vertices welded along matching borders; no step is needed"));
}

TEST(Seams, OffAndPlyFollowTheSameRule) {
  const std::string body =
      "0 0 0\n4 0 0\n0 4 0\n0 0 4\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n"
      "3 0 2 1\n3 0 1 3\n3 5 6 7\n3 4 7 6\n";
  for (const std::string& header :
       {std::string("OFF\n8 4 0\n"),
        std::string("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
                    "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
                    "end_header\n")}) {
    SCOPED_TRACE(header);
    const auto result = built(header + body);
    EXPECT_EQ(result.boundary_edges, 0u);
    EXPECT_EQ(result.mesh.positions.size(), 4u);
    EXPECT_THAT(result.repairs, Contains(HasSubstr("4 repeated vertices welded")));
  }
}

TEST(Seams, ASlitInASheetIsClosed) {
  const auto result = built(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nv 1 0 0\n"
      "f 1 2 5\nf 6 3 5\nf 3 4 5\nf 4 1 5\n");
  EXPECT_EQ(result.boundary_edges, 4u);
  EXPECT_EQ(result.mesh.positions.size(), 5u);
  EXPECT_THAT(result.repairs,
              ElementsAre("1 repeated vertex welded along matching borders; no step is needed"));
}

TEST(Seams, ASideThatRunsTheWrongWayIsWeldedAndTurned) {
  const auto result = built(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\n"
      "f 1 2 3\nf 4 5 6\nf 4 6 7\n");
  EXPECT_EQ(result.components, 1u);
  EXPECT_EQ(result.mesh.positions.size(), 5u);
  EXPECT_THAT(result.repairs, Contains(HasSubstr("1 face reversed")));
}

TEST(Seams, SidesOfDifferentColoursStayApart) {
  const auto result = built(
      "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\n"
      "v 1 0 0 0 0 1\nv 1 1 0 0 0 1\nv 0 1 0 0 0 1\nf 1 2 3\nf 4 5 6\n");
  EXPECT_EQ(result.mesh.positions.size(), 6u);
  EXPECT_EQ(result.boundary_edges, 6u);
  EXPECT_THAT(result.repairs, IsEmpty());
}

TEST(Seams, SidesOfEqualColoursAreWelded) {
  const auto result = built(
      "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\n"
      "v 1 0 0 1 0 0\nv 1 1 0 0 0 1\nv 0 1 0 1 0 0\nf 1 2 3\nf 4 5 6\n");
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(Colour{255, 0, 0}, Colour{255, 0, 0},
                                                          Colour{255, 0, 0}, Colour{0, 0, 255}));
}

// A tetrahedron at the origin and its mirror image, as OBJ. Each has its own vertices. In the first
// file, the two touch at a point; in the second, along an edge.
constexpr char kTouchingAtAPoint[] =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 0\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\n"
    "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 5 6 7\nf 5 8 6\nf 6 8 7\nf 7 8 5\n";
constexpr char kTouchingAlongAnEdge[] =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 0\nv -1 0 0\nv 0 -1 0\nv 0 0 1\n"
    "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n";

TEST(Seams, ClosedSolidsThatTouchAreLeftAsTheyAre) {
  for (const char* text : {kTouchingAtAPoint, kTouchingAlongAnEdge}) {
    const auto result = built(text);
    EXPECT_EQ(result.mesh.positions.size(), 8u);
    EXPECT_EQ(result.mesh.faces[4][0], 4u);
    EXPECT_EQ(result.components, 2u);
    EXPECT_EQ(result.boundary_edges, 0u);
    EXPECT_THAT(result.repairs, IsEmpty());
  }
}

TEST(Seams, SheetsThatTouchAtAPointStayApart) {
  const auto result = built(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv -1 0 0\nv 0 -1 0\n"
      "f 1 2 3\nf 4 5 6\n");
  EXPECT_EQ(result.mesh.positions.size(), 6u);
  EXPECT_THAT(result.repairs, IsEmpty());
}

TEST(Seams, ThreeBordersOnOneLineStayApart) {
  const auto result = built(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 -1 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\n"
      "f 1 2 3\nf 5 4 6\nf 7 8 9\n");
  EXPECT_EQ(result.mesh.positions.size(), 9u);
  EXPECT_THAT(result.repairs, IsEmpty());
}

TEST(Seams, ABorderOnAnInnerEdgeStaysApart) {
  const auto result = built(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\n"
      "f 1 2 3\nf 2 1 4\nf 5 6 7\n");
  EXPECT_EQ(result.mesh.positions.size(), 7u);
  EXPECT_THAT(result.repairs, IsEmpty());
}

TEST(Seams, ACopyOfASheetAndItsBackStayApart) {
  for (const char* copy : {"f 4 5 6\n", "f 4 6 5\n"}) {
    const auto result = built(std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                          "f 1 2 3\n") +
                              copy);
    EXPECT_EQ(result.mesh.positions.size(), 6u);
    EXPECT_EQ(result.components, 2u);
    EXPECT_THAT(result.repairs, IsEmpty());
  }
}

TEST(Seams, EdgesThatArePointsAreNone) {
  const auto result = read_text(
      "v 0 0 0\nv 0 0 0\nv 1 0 0\nv 0 0 0\nv 0 0 0\nv 0 1 0\n"
      "f 1 2 3\nf 4 5 6\n");
  EXPECT_EQ(result.mesh.positions.size(), 6u);
  EXPECT_THAT(result.repairs, IsEmpty());
}

// Each face of a grid gets its own vertices, and faces are shuffled. Repair must restore the grid.
TEST(Seams, AnySoupOfTheFacesOfASurfaceIsThatSurface) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const auto side = 1 + static_cast<std::uint32_t>(random()) % 6;
    const TriangleMesh whole = vitrine::testing::grid(side);
    std::vector<Triangle> faces = whole.faces;
    std::shuffle(faces.begin(), faces.end(), random);
    std::string text;
    for (const Triangle& face : faces) {
      for (const std::uint32_t v : face) {
        const Vec3& p = whole.positions[v];
        text += "v " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z) +
                '\n';
      }
      text += "f -3 -2 -1\n";
    }
    const auto result = built(text);
    EXPECT_EQ(result.mesh.positions.size(), whole.positions.size()) << "seed " << seed;
    EXPECT_EQ(result.boundary_edges, 4 * side) << "seed " << seed;
    EXPECT_EQ(result.mesh.faces.size(), faces.size()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace vitrine
