// SPDX-License-Identifier: Apache-2.0
#include "codec/export/write_mesh.h"
#include "codec/import/reading.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using vitrine::testing::as_bytes;
using vitrine::testing::as_text;
using vitrine::testing::read_text;
using vitrine::testing::tetrahedron;

constexpr char kObj[] = "v 0 0 0\nv 1 2 3\nv 0 1 0\nf 1 2 3\n";

std::string unit_of(const std::string& comment) {
  return read_text(comment + kObj).unit;
}

TEST(Unit, IsReadFromTheCommentsOfAnObj) {
  EXPECT_EQ(unit_of(""), "");
  EXPECT_EQ(unit_of("# exported\n# Units: Millimeters\n"), "mm");
  EXPECT_EQ(unit_of("# units are in inches\r\n"), "in");
  EXPECT_EQ(unit_of("# units: in\n"), "in");
  EXPECT_EQ(unit_of("# units in cm, y up\n"), "cm");
  EXPECT_EQ(unit_of("# 1 unit = 1 m\n"), "m");
}

TEST(Unit, IsUnknownWhereACommentSaysSomethingElse) {
  EXPECT_EQ(unit_of("# unit normals\n"), "");
  EXPECT_EQ(unit_of("# 1 unit = 0.1 mm\n"), "");
  EXPECT_EQ(unit_of("# in mm\n"), "");
  EXPECT_EQ(unit_of("# units in world coordinate system\n"), "");
  EXPECT_EQ(unit_of("# Units are in world space\n"), "");
  EXPECT_EQ(unit_of("# unit: in local space\n"), "");
  EXPECT_EQ(unit_of("# units: in, y up\n"), "in");
  EXPECT_EQ(read_text(std::string(kObj) + "# unit mm\n").unit, "");
}

TEST(Unit, IsReadFromEveryFormatThatVitrineWritesItInto) {
  for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kObj, MeshFormat::kStl}) {
    EXPECT_EQ(read_text(as_text(*write_mesh(tetrahedron(), format, {.unit = "mm"}))).unit, "mm");
    EXPECT_EQ(read_text(as_text(*write_mesh(tetrahedron(), format))).unit, "");
  }
  EXPECT_EQ(read_text("solid bust UNITS=cm\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                      "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n")
                .unit,
            "cm");
  EXPECT_EQ(read_text("OFF\n# unit m\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").unit, "m");
}

TEST(Unit, OfAGlbIsTheMetreAndItIsWrittenInMetres) {
  const auto known =
      read_text(as_text(*write_mesh(tetrahedron(), MeshFormat::kGlb, {.unit = "in"})));
  EXPECT_EQ(known.unit, "m");
  EXPECT_FLOAT_EQ(static_cast<float>(known.mesh.positions[1].x), 0.0254f);
  const auto unknown = read_text(as_text(*write_mesh(tetrahedron(), MeshFormat::kGlb)));
  EXPECT_EQ(unknown.mesh.positions[1].x, 1);
}

TEST(Unit, ThatIsGivenGoesBeforeTheOneThatTheFileStates) {
  const std::string text = std::string("# unit mm\n") + kObj;
  EXPECT_EQ(read_mesh(as_bytes(text), {.unit = "in"})->unit, "in");
}

TEST(UpAxis, ZIsTurnedToYAndNothingIsMirrored) {
  const auto read = read_mesh(as_bytes(kObj), {.up = UpAxis::kZ});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mesh.positions[1], (Vec3{1, 3, -2}));
  EXPECT_THAT(read->mesh.faces, ElementsAre(Triangle{0, 1, 2}));
}

}  // namespace
}  // namespace vitrine
