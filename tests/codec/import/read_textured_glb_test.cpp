// SPDX-License-Identifier: Apache-2.0
#include "codec/import/glb_builder.h"
#include "codec/import/pictures.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vitrine::testing::GlbBuilder;
using vitrine::testing::jpeg_of;
using vitrine::testing::kBetween;
using vitrine::testing::kBlue;
using vitrine::testing::kRed;
using vitrine::testing::read_text;
using vitrine::testing::red_and_blue;
using vitrine::testing::refusal;
using Json = nlohmann::json;

// One triangle whose corners are at u = 0.25, 0.75 and 1.25 of `picture`.
GlbBuilder textured(const std::string& picture) {
  GlbBuilder builder;
  const std::size_t points = builder.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  const std::size_t places = builder.floats("VEC2", {0.25, 0, 0.75, 0, 1.25, 0}, 3);
  builder.append("images", {{"bufferView", builder.view(picture)}, {"mimeType", "image/png"}});
  builder.append("samplers", Json::object());
  builder.append("textures", {{"source", 0}, {"sampler", 0}});
  builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  builder.mesh({{"attributes", {{"POSITION", points}, {"TEXCOORD_0", places}}}, {"material", 0}});
  return builder;
}

Json& surface(GlbBuilder& builder) {
  return builder.document["materials"][0]["pbrMetallicRoughness"];
}

TEST(ReadTexturedGlb, TheTextureIsBakedAndThatIsSaid) {
  const auto result = read_text(textured(red_and_blue()).file());
  EXPECT_THAT(result.mesh.colours, ElementsAre(kRed, kBlue, kRed));
  EXPECT_THAT(result.repairs, ElementsAre("1 texture map baked into vertex colours"));
}

TEST(ReadTexturedGlb, TheSamplerSaysHowThePictureGoesOn) {
  GlbBuilder builder = textured(red_and_blue());
  builder.document["samplers"][0] = {{"wrapS", 33071}};
  EXPECT_THAT(read_text(builder.file()).mesh.colours, ElementsAre(kRed, kBlue, kBlue));
}

TEST(ReadTexturedGlb, TheTransformMovesThePicture) {
  GlbBuilder builder = textured(red_and_blue());
  surface(builder)["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.5, 0}}};
  EXPECT_THAT(read_text(builder.file()).mesh.colours, ElementsAre(kBlue, kRed, kBlue));
}

TEST(ReadTexturedGlb, FactorAndVertexColoursAreMultipliedInLinearLight) {
  GlbBuilder builder = textured(red_and_blue());
  surface(builder)["baseColorFactor"] = {0.5, 1, 0.5, 1};
  const std::size_t colours = builder.floats("VEC3", {1, 1, 1, 0, 0, 0, 0.5, 1, 1}, 3);
  builder.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colours;
  EXPECT_THAT(read_text(builder.file()).mesh.colours,
              ElementsAre(Colour{188, 0, 0}, Colour{0, 0, 0}, Colour{137, 0, 0}));
}

TEST(ReadTexturedGlb, AFactorAloneIsBakedToo) {
  GlbBuilder builder;
  const std::size_t points = builder.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 1}}}}});
  builder.mesh({{"attributes", {{"POSITION", points}}}, {"material", 0}});
  const auto result = read_text(builder.file());
  const Colour orange{255, 188, 0};
  EXPECT_THAT(result.mesh.colours, ElementsAre(orange, orange, orange));
  EXPECT_THAT(result.repairs, ElementsAre("material colours baked into vertex colours"));
}

TEST(ReadTexturedGlb, VerticesOnASeamAreWeldedToTheMeanOfTheirColours) {
  GlbBuilder builder = textured(red_and_blue());
  const std::size_t points =
      builder.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0}, 6);
  const std::size_t places =
      builder.floats("VEC2", {0.25, 0, 0.25, 0, 0.25, 0, 0.75, 0, 0.75, 0, 0.75, 0}, 6);
  builder.document["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", points},
                                                                  {"TEXCOORD_0", places}};
  const auto result = read_text(builder.file());
  EXPECT_THAT(result.mesh.colours, ElementsAre(kRed, kBetween, kBetween, kBlue));
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}));
  EXPECT_THAT(result.repairs, Contains(HasSubstr("2 repeated vertices welded")));
}

TEST(ReadTexturedGlb, AJpegIsRead) {
  const std::string picture = jpeg_of(std::vector<std::uint8_t>(192, 100), 8);
  EXPECT_NEAR(read_text(textured(picture).file()).mesh.colours.at(0)[0], 100, 3);
}

TEST(ReadTexturedGlb, APictureThatCannotBeReadIsNamedAndTheMeshStays) {
  const auto other = read_text(textured("RIFF....WEBPVP8 ").file());
  EXPECT_THAT(other.mesh.colours, ElementsAre());
  EXPECT_THAT(other.repairs, ElementsAre("texture map 0 not carried: it is neither PNG nor JPEG"));
  const auto cut = read_text(textured(red_and_blue().substr(0, 50)).file());
  EXPECT_THAT(cut.repairs, ElementsAre("texture map 0 not carried: it is a damaged PNG"));
  GlbBuilder outside = textured(red_and_blue());
  outside.document["images"][0] = {{"uri", "skin.png"}};
  EXPECT_THAT(read_text(outside.file()).repairs,
              ElementsAre("texture map 0 not carried: it is not in the file"));
}

TEST(ReadTexturedGlb, RefusesCoordinatesThatAreMissingOrDoNotMatch) {
  GlbBuilder missing = textured(red_and_blue());
  surface(missing)["baseColorTexture"]["texCoord"] = 1;
  EXPECT_THAT(refusal(missing.file()), HasSubstr("TEXCOORD_1"));
  GlbBuilder short_by_one = textured(red_and_blue());
  short_by_one.document["accessors"][1]["count"] = 2;
  EXPECT_THAT(refusal(short_by_one.file()), HasSubstr("TEXCOORD_0 does not match POSITION"));
}

}  // namespace
}  // namespace vitrine
