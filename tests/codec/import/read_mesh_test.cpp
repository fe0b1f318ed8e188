// SPDX-License-Identifier: Apache-2.0
#include "codec/import/reading.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vitrine::testing::read_text;
using vitrine::testing::refusal;

TEST(ReadMesh, RefusesAnEmptyFile) {
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
}

TEST(ReadMesh, RefusesOtherContentWhateverTheNameOfTheFile) {
  for (const char* text : {"Dear museum,\nhere is the scan.", "ASTM", "BM", "\n\n"}) {
    EXPECT_THAT(refusal(text), HasSubstr("not a mesh file that Vitrine reads; convert it to PLY, "
                                         "GLB, glTF, STL, OFF, 3MF, DAE, FBX or OBJ"));
  }
}

TEST(ReadMesh, AByteOrderMarkBeforeAnyTextIsSteppedOver) {
  const std::string mark = "\xEF\xBB\xBF";
  for (const std::string text :
       {"# unit mm\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "Solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid x\n",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}) {
    const auto plain = read_text(text), marked = read_text(mark + text);
    EXPECT_EQ(marked.mesh.positions, plain.mesh.positions);
    EXPECT_THAT(marked.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
    EXPECT_EQ(marked.unit, plain.unit);
  }
  EXPECT_THAT(refusal(mark), HasSubstr("not a mesh file"));
}

TEST(ReadMesh, OneEThirtyInSinglePrecisionIsStillACoordinate) {
  EXPECT_EQ(read_text("v 0 0 0\nv 1.00000002e30 0 0\nv 0 1 0\nf 1 2 3\n").mesh.faces.size(), 1u);
  EXPECT_THAT(refusal("v 0 0 0\nv 1.1e30 0 0\nv 0 1 0\nf 1 2 3\n"), HasSubstr("beyond 1e30"));
}

TEST(ReadMesh, RefusesPointsWithoutFaces) {
  EXPECT_THAT(refusal("v 0 0 0\nv 1 0 0\n"), HasSubstr("has 2 points but no faces"));
}

TEST(ReadMesh, RefusesAFaceWhoseVertexIsMissingAndNamesIt) {
  EXPECT_THAT(
      refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n"),
      HasSubstr(
          "OBJ line 5: this face refers to vertex 4 (counted from 1), but the file has only 3"));
}

TEST(ReadMesh, RefusesANumberThatIsNotFiniteWhereAFaceUsesIt) {
  EXPECT_THAT(refusal("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"),
              HasSubstr("vertex 2 (counted from 1) has"));
  EXPECT_THAT(refusal("v 0 0 0\nv 1 inf 0\nv 0 1 0\nf 1 2 3\n"), HasSubstr("not a finite number"));
  EXPECT_THAT(refusal("v 0 0 0\nv 1 1e999 0\nv 0 1 0\nf 1 2 3\n"), HasSubstr("vertex 2"));
}

TEST(ReadMesh, DropsPointsThatAreNotFiniteWhereNoFaceUsesThem) {
  const auto result = read_text("v nan nan nan\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n");
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_EQ(result.mesh.positions.size(), 3u);
  EXPECT_THAT(result.repairs, ElementsAre(HasSubstr("1 point without finite coordinates dropped")));
}

TEST(ReadMesh, NamesFacesOfFewerThanThreeCorners) {
  const auto result = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
  EXPECT_THAT(result.repairs, ElementsAre("1 face with fewer than three corners dropped, first at "
                                          "face 1; convert what you need to polygons"));
}

TEST(ReadMesh, RefusesMoreThanTheLimits) {
  Limits limits;
  limits.faces = 1;
  const auto result =
      read_mesh(vitrine::testing::as_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4 3\n"),
                {.limits = limits});
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kLimit);
}

}  // namespace
}  // namespace vitrine
