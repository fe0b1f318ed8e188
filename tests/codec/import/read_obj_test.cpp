// SPDX-License-Identifier: Apache-2.0
#include "codec/import/reading.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using vitrine::testing::read_text;
using vitrine::testing::refusal;

constexpr char kSquare[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, FacesInEveryNotation) {
  const auto result = read_text(std::string("# a comment\n\no thing\n") + kSquare +
                                "vn 0 0 1\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 3//1 4//1\n"
                                "f 1/1/1 3/1/1 4/1/1 # end\ns 1\n");
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 2},
                                             Triangle{0, 2, 3}, Triangle{0, 2, 3}));
  EXPECT_THAT(result.repairs, IsEmpty());
}

TEST(ReadObj, PolygonsAndNegativeIndices) {
  const auto result = read_text(std::string(kSquare) + "f -4 -3 -2 -1\nv 0 0 1\nf -1 1 2\n");
  EXPECT_THAT(result.mesh.faces,
              ElementsAre(Triangle{4, 0, 1}, Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(ReadObj, APolygonOfManyCornersIsCutWithoutARepair) {
  std::string vertices, face = "f";
  for (int i = 1; i <= 257; ++i) {
    vertices += "v " + std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
    face += " " + std::to_string(i);
  }
  const auto result = read_text(vertices + face + "\n");
  EXPECT_EQ(result.mesh.faces.size(), 255u);
  EXPECT_THAT(result.repairs, IsEmpty());
}

TEST(ReadObj, LinesThatContinue) {
  const auto result =
      read_text(std::string(kSquare) + "f 1 \\\n 2 \\\r\n 3\nv 5 \\\n5 5\nf 1 2 5\n");
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 4}));
}

TEST(ReadObj, LinesMayEndInAnyWayAndFaultsKeepTheirLine) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char* line :
         {"# first", "", "v 0 0 0", "v 1 0 0", "v 0 1 0", "f 1 \\", "2 3", "f 0"})
      text += line + end;
    EXPECT_THAT(refusal(text), HasSubstr("OBJ line 8: "));
    const auto result = read_text(text.substr(0, text.rfind("f 0")));
    EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
  }
}

TEST(ReadObj, ReadsColoursFrom0To1AndFrom0To255) {
  const auto result = read_text("v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  EXPECT_THAT(result.mesh.attributes.colours,
              ElementsAre(Colour{255, 128, 0}, Colour{255, 255, 255}, Colour{0, 0, 255}));
  const auto bytes = read_text("v 0 0 0 255 128 7\nv 1 0 0 0 1 2\nv 0 1 0 3 4 5\nf 1 2 3\n");
  EXPECT_THAT(bytes.mesh.attributes.colours,
              ElementsAre(Colour{255, 128, 7}, Colour{0, 1, 2}, Colour{3, 4, 5}));
}

TEST(ReadObj, AWeightIsNoColour) {
  EXPECT_THAT(read_text("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").mesh.attributes.colours,
              IsEmpty());
}

TEST(ReadObj, SaysThatATextureIsNotCarried) {
  const auto result = read_text(
      "mtllib bust.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl skin\n"
      "f 1/1 2/1 3/1\n");
  EXPECT_THAT(
      result.repairs,
      ElementsAre("1 material library 'bust.mtl' not carried: it is not beside the mesh file; copy "
                  "it there, or pack both in one zip"));
}

TEST(ReadObj, NamesTheLineOfAFault) {
  EXPECT_THAT(refusal("v 0 0 0\nv 1 zero 0\n"), HasSubstr("line 2: a vertex needs three numbers"));
  EXPECT_THAT(refusal("v 0 0 0\nf 0 1 1\n"), HasSubstr("line 2: a face needs"));
  EXPECT_THAT(refusal("v 0 0 0\nf 1 1 -2\n"), HasSubstr("line 2: a face needs"));
  EXPECT_THAT(refusal("v 0 0 0\nf 1 1 99999999999\n"), HasSubstr("line 2: this face refers to a"));
  EXPECT_THAT(refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 3 4\nf 1 2 3\n"),
              HasSubstr("OBJ line 5: this face refers to vertex 4 (counted from 1)"));
}

TEST(ReadObj, RefusesAFileThatEndsWithinAFace) {
  const std::string whole = std::string(kSquare) + "f 1 2 3\nf 1 3 4";
  EXPECT_EQ(read_text(whole).mesh.faces.size(), 2u);
  for (const int lost : {1, 2, 3, 4, 5, 6}) {
    EXPECT_THAT(refusal(whole.substr(0, whole.size() - static_cast<std::size_t>(lost))),
                HasSubstr("OBJ line 6: the file ends within this face; it is cut short"));
  }
  EXPECT_EQ(read_text(std::string(kSquare) + "f 1 2 3\nf 1 3\n").mesh.faces.size(), 1u);
}

}  // namespace
}  // namespace vitrine
