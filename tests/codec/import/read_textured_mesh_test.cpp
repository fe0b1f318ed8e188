// SPDX-License-Identifier: Apache-2.0
// Tests OBJ and PLY files with pictures in companion files.
#include "codec/import/reading.h"
#include "codec/picture/pictures.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using vitrine::testing::as_bytes;
using vitrine::testing::expect_counts_and_steps;
using vitrine::testing::kBetween;
using vitrine::testing::kBlue;
using vitrine::testing::kRed;
using vitrine::testing::read_text;
using vitrine::testing::red_and_blue;

const std::string kPicture = red_and_blue();

ImportedMesh read_with(const std::string& text, const std::map<std::string, std::string>& files) {
  Companions beside;
  for (const auto& [name, contents] : files)
    beside[name] = as_bytes(contents);
  auto result = read_mesh(as_bytes(text), {.beside = beside});
  if (result) expect_counts_and_steps(result->repairs);
  EXPECT_TRUE(result.has_value());
  return result ? *std::move(result) : ImportedMesh{};
}

const std::string kLibrary =
    "# materials\nnewmtl plain\nKd 0.2 0.4 0.6\nnewmtl my skin\nKd 0 0 0\n"
    "map_Kd -s 1 1 1 C:\\scans\\Skin.PNG\n";

const std::string kObj =
    "mtllib bust.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"
    "vt 0.25 0\nvt 0.75 0\nusemtl my skin\nf 1/1 2/1 3/1\n";

TEST(ReadTexturedObj, ThePictureOfTheMaterialIsBaked) {
  const auto result = read_with(kObj, {{"bust.mtl", kLibrary}, {"skin.png", kPicture}});
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(kRed, kRed, kRed, Colour{255, 255, 255}));
  EXPECT_THAT(result.repairs,
              ElementsAre("1 texture map baked into vertex colours; no step is needed"));
}

TEST(ReadTexturedObj, AVertexOnASeamTakesTheMeanOfItsCorners) {
  const auto result =
      read_with(kObj + "f 3/-1 2/-1 4/-1\n", {{"bust.mtl", kLibrary}, {"skin.png", kPicture}});
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(kRed, kBetween, kBetween, kBlue));
}

TEST(ReadTexturedObj, AMaterialWithoutPictureGivesItsColour) {
  const auto result =
      read_with(kObj + "usemtl plain\nf 4 2 3\n", {{"bust.mtl", kLibrary}, {"skin.png", kPicture}});
  EXPECT_EQ(result.mesh.attributes.colours[3], (Colour{51, 102, 153}));
  EXPECT_THAT(result.repairs,
              Contains(HasSubstr("colours of 1 material baked into vertex colours; ")));
}

TEST(ReadTexturedObj, MaterialsThatMeetAlongASeamAreWeldedToTheMeanOfTheirColours) {
  const auto result = read_with(
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\n"
      "usemtl red\nf 1 2 3\nusemtl blue\nf 4 5 6\n",
      {{"a.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n"}});
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}));
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(kRed, kBetween, kBetween, kBlue));
  EXPECT_THAT(result.repairs, Contains(HasSubstr("2 repeated vertices welded")));
}

TEST(ReadTexturedObj, WhatIsMissingIsNamed) {
  const auto result = read_with(kObj, {{"bust.mtl", kLibrary}});
  EXPECT_THAT(result.repairs, Contains(HasSubstr("Skin.PNG' not carried: it is not beside")));
  EXPECT_THAT(read_with(kObj, {}).mesh.attributes.colours, ElementsAre());
}

TEST(ReadTexturedObj, ColoursOfTheVerticesGoFirst) {
  std::string text = kObj;
  text.replace(text.find("v 0 0 0\n"), 8, "v 0 0 0 0 1 0\n");
  const auto result = read_with(text, {{"bust.mtl", kLibrary}, {"skin.png", kPicture}});
  EXPECT_EQ(result.mesh.attributes.colours[0], (Colour{0, 255, 0}));
  EXPECT_THAT(result.repairs, Not(Contains(HasSubstr("not carried"))));
  EXPECT_FALSE(result.texturing.empty());
  const auto plain = read_with(text, {{"bust.mtl", "newmtl my skin\nKd 1 0 0\n"}});
  EXPECT_THAT(plain.repairs, Contains(HasSubstr("the vertices have colours of their own")));
}

std::string ply(const std::string& vertex, const std::string& face, const std::string& body) {
  return "ply\nformat ascii 1.0\ncomment TextureFile my skin.png\nelement vertex 4\n"
         "property float x\nproperty float y\nproperty float z\n" +
         vertex + "element face 2\nproperty list uchar int vertex_indices\n" + face +
         "end_header\n" + body;
}

TEST(ReadTexturedPly, CoordinatesOfVertices) {
  const auto result =
      read_with(ply("property float s\nproperty float t\n", "",
                    "0 0 0 0.25 0\n1 0 0 0.25 1\n0 1 0 0.75 0\n1 1 0 0.5 0\n3 0 1 2\n3 2 1 3\n"),
                {{"my skin.png", kPicture}});
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(kRed, kRed, kBlue, kBetween));
  EXPECT_THAT(result.repairs,
              ElementsAre("1 texture map baked into vertex colours; no step is needed"));
}

TEST(ReadTexturedPly, CoordinatesOfCorners) {
  const auto result = read_with(ply("", "property list uchar float texcoord\n",
                                    "0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
                                    "3 0 1 2 6 0.25 0 0.25 0 0.25 0\n"
                                    "3 2 1 3 6 0.75 0 0.75 0 0.75 0\n"),
                                {{"my skin.png", kPicture}});
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(kRed, kBetween, kBetween, kBlue));
}

TEST(ReadTexturedPly, VerticesRepeatedAlongASeamAreWeldedAndAnOpenBorderStays) {
  const auto result = read_text(
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n0 1 0 1 0 0\n1 0 0 1 0 0\n1 1 0 1 0 0\n"
      "3 0 1 2\n3 3 4 5\n");
  EXPECT_EQ(result.mesh.positions.size(), 4u);
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}));
  EXPECT_THAT(result.repairs, ElementsAre(HasSubstr("2 repeated vertices welded")));
}

}  // namespace
}  // namespace vitrine
