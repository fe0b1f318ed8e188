// SPDX-License-Identifier: Apache-2.0
#include "codec/export/write_mesh.h"
#include "codec/import/reading.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vitrine::testing::as_text;
using vitrine::testing::read_text;
using vitrine::testing::refusal;
using vitrine::testing::tetrahedron;

constexpr char kTwoFacets[] =
    "solid bust with a name\n"
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\n"
    "endfacet\n"
    "FACET NORMAL 0 0 1 OUTER LOOP VERTEX 1 0 0 VERTEX 1 1 0 VERTEX -0 1 0 ENDLOOP ENDFACET\n"
    "endsolid bust\n";

TEST(ReadStl, TextIsWeldedByExactPosition) {
  const auto result = read_text(kTwoFacets);
  EXPECT_EQ(result.mesh.positions.size(), 4u);
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
}

TEST(ReadStl, BinaryIsWeldedByExactPosition) {
  const auto result = read_text(as_text(*write_mesh(tetrahedron(), MeshFormat::kStl)));
  EXPECT_EQ(result.mesh.positions.size(), 4u);
  EXPECT_EQ(result.mesh.faces.size(), 4u);
}

TEST(ReadStl, ABinaryFileThatStartsWithSolidIsStillBinary) {
  std::string file = as_text(*write_mesh(tetrahedron(), MeshFormat::kStl));
  file.replace(0, 6, "solid ");
  EXPECT_EQ(read_text(file).mesh.faces.size(), 4u);
  EXPECT_EQ(read_text(file + "tail").mesh.faces.size(), 4u);
}

TEST(ReadStl, TrailingBytesAfterABinaryFileAreIgnored) {
  EXPECT_EQ(
      read_text(as_text(*write_mesh(tetrahedron(), MeshFormat::kStl)) + "tail").mesh.faces.size(),
      4u);
}

TEST(ReadStl, OtherBytesAreNoBinaryFileThatIsCutShort) {
  std::string utf16;
  for (const char c : std::string(100, 'v'))
    utf16 += {c, '\0'};
  EXPECT_THAT(refusal(utf16), HasSubstr("not a mesh file"));
  EXPECT_THAT(refusal(std::string(84, '\0') + std::string(300, '\xFF')),
              HasSubstr("not a mesh file"));
}

TEST(ReadStl, RefusesDisorderedText) {
  EXPECT_THAT(refusal("solid a\nvertex 0 0 0\nvertex 0 0\nendsolid"), HasSubstr("line 4"));
  EXPECT_THAT(refusal("solid a\nouter loop vertex 0 0 0 endloop\nendsolid"),
              HasSubstr("line 2: 'endloop'"));
}

TEST(ReadStl, RefusesACoordinateThatIsNotFinite) {
  EXPECT_THAT(refusal("solid a\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex nan 0 0 "
                      "vertex 0 1 0 endloop endfacet\nendsolid"),
              HasSubstr("facet 0"));
}

}  // namespace
}  // namespace vitrine
