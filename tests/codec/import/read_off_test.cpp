// SPDX-License-Identifier: Apache-2.0
#include "codec/import/reading.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vitrine::testing::expect_first_dropped;
using vitrine::testing::expect_first_named;
using vitrine::testing::kNotFinite;
using vitrine::testing::read_text;
using vitrine::testing::refusal;

TEST(ReadOff, PolygonsCommentsAndFaceColours) {
  const auto result = read_text(
      "# made by hand\nOFF # the header\n\n4 2 0\n0 0 0\n# between\n1 0 0\n1 1 0\n0 1 0\n"
      "4 0 1 2 3 255 0 0\n3 0 1 2 0.5 0.5 0.5 1\n");
  EXPECT_THAT(result.mesh.faces,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(ReadOff, CountsOnTheHeadersLineAndWithoutEdges) {
  EXPECT_EQ(read_text("OFF 3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").mesh.positions.size(), 3u);
}

TEST(ReadOff, VertexColoursAndNormals) {
  const auto coloured =
      read_text("COFF\n3 1 0\n0 0 0 255 128 0 255\n1 0 0 0 1 2 255\n0 1 0 3 4 5 255\n3 0 1 2\n");
  EXPECT_THAT(coloured.mesh.attributes.colours,
              ElementsAre(Colour{255, 128, 0}, Colour{0, 1, 2}, Colour{3, 4, 5}));
  const auto both = read_text(
      "CNOFF\n3 1 0\n0 0 0 0 0 1 1 0.5 0\n1 0 0 0 0 1 0 0 0\n0 1 0 0 0 1 0 0 1\n3 0 1 2\n");
  EXPECT_THAT(both.mesh.attributes.colours,
              ElementsAre(Colour{255, 128, 0}, Colour{0, 0, 0}, Colour{0, 0, 255}));
  EXPECT_EQ(
      read_text("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n").mesh.positions[1],
      (Vec3{1, 0, 0}));
}

TEST(ReadOff, CoordinatesThatAreNotFinite) {
  for (const auto& [text, value] : kNotFinite) {
    SCOPED_TRACE(text);
    const std::string vertices = std::string("OFF\n4 1 0\n") + text + " 0 0\n0 0 0\n1 0 0\n0 1 0\n";
    expect_first_dropped(read_text(vertices + "3 1 2 3\n"));
    expect_first_named(vertices + "3 0 1 2\n");
  }
}

TEST(ReadOff, RefusesByName) {
  EXPECT_THAT(refusal("OFF\n3000000000 1 0\n0 0 0\n"), HasSubstr("claims 3000000000 vertices"));
  EXPECT_THAT(refusal("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), HasSubstr("line 4: vertex 1"));
  EXPECT_THAT(refusal("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), HasSubstr("face 0"));
  EXPECT_THAT(refusal("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n# faces\n3 0 1 3\n"),
              HasSubstr("OFF line 7: this face refers to vertex 3 (counted from 0)"));
  EXPECT_THAT(refusal("OFF BINARY\n\1\2\3"), HasSubstr("binary OFF is not read"));
  EXPECT_THAT(refusal("4OFF\n1 1 0\n0 0 0 1\n"), HasSubstr("four or n dimensions"));
}

}  // namespace
}  // namespace vitrine
