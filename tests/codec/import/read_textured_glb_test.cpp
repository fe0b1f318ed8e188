// SPDX-License-Identifier: Apache-2.0
#include "codec/import/textured_gltf.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using vitrine::testing::as_bytes;
using vitrine::testing::GlbBuilder;
using vitrine::testing::jpeg_of;
using vitrine::testing::kBetween;
using vitrine::testing::kBlue;
using vitrine::testing::kRed;
using vitrine::testing::read_text;
using vitrine::testing::red_and_blue;
using vitrine::testing::refusal;
using vitrine::testing::textured;
using vitrine::testing::webp_of;
using Json = nlohmann::json;

Json& surface(GlbBuilder& builder) {
  return builder.document["materials"][0]["pbrMetallicRoughness"];
}

TEST(ReadTexturedGlb, TheTextureIsBakedAndThatIsSaid) {
  const auto result = read_text(textured(red_and_blue()).file());
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(kRed, kBlue, kRed));
  EXPECT_THAT(result.repairs,
              ElementsAre("1 texture map baked into vertex colours; no step is needed"));
}

TEST(ReadTexturedGlb, TheSamplerSaysHowThePictureGoesOn) {
  GlbBuilder builder = textured(red_and_blue());
  builder.document["samplers"][0] = {{"wrapS", 33071}};
  EXPECT_THAT(read_text(builder.file()).mesh.attributes.colours, ElementsAre(kRed, kBlue, kBlue));
}

TEST(ReadTexturedGlb, TheTransformMovesThePicture) {
  GlbBuilder builder = textured(red_and_blue());
  auto& extensions = surface(builder)["baseColorTexture"]["extensions"];
  extensions["KHR_texture_transform"] = {{"offset", {0.5, 0}}};
  EXPECT_THAT(read_text(builder.file()).mesh.attributes.colours, ElementsAre(kBlue, kRed, kBlue));
}

TEST(ReadTexturedGlb, FactorAndVertexColoursAreMultipliedInLinearLight) {
  GlbBuilder builder = textured(red_and_blue());
  surface(builder)["baseColorFactor"] = {0.5, 1, 0.5, 1};
  const std::size_t colours = builder.floats("VEC3", {1, 1, 1, 0, 0, 0, 0.5, 1, 1}, 3);
  builder.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colours;
  EXPECT_THAT(read_text(builder.file()).mesh.attributes.colours,
              ElementsAre(Colour{188, 0, 0}, Colour{0, 0, 0}, Colour{137, 0, 0}));
}

TEST(ReadTexturedGlb, AFactorAloneIsBakedToo) {
  GlbBuilder builder;
  const std::size_t points = builder.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 1}}}}});
  builder.mesh({{"attributes", {{"POSITION", points}}}, {"material", 0}});
  const auto result = read_text(builder.file());
  const Colour orange{255, 188, 0};
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(orange, orange, orange));
  EXPECT_THAT(result.repairs,
              ElementsAre(HasSubstr("colours of 1 material baked into vertex colours; ")));
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
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(kRed, kBetween, kBetween, kBlue));
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}));
  EXPECT_THAT(result.repairs, Contains(HasSubstr("2 repeated vertices welded")));
}

TEST(ReadTexturedGlb, AJpegIsRead) {
  const std::string picture = jpeg_of(std::vector<std::uint8_t>(192, 100), 8);
  EXPECT_NEAR(read_text(textured(picture).file()).mesh.attributes.colours.at(0)[0], 100, 3);
}

// Returns the fault that the reader reports for the only picture of a glTF file.
std::string fault_of(const GlbBuilder& builder) {
  const auto result = read_text(builder.file());
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre());
  EXPECT_EQ(result.mesh.faces.size(), 1u);
  EXPECT_THAT(result.repairs, SizeIs(1));
  return result.repairs.empty() ? "" : result.repairs.front();
}

TEST(ReadTexturedGlb, APictureThatCannotBeReadIsNamedAndTheMeshStays) {
  EXPECT_EQ(fault_of(textured("P6 1 1 255 ...")),
            "1 texture map, image 0, not carried: it is not PNG, JPEG, WebP, TIFF, BMP or TGA; "
            "convert it to one of them");
  EXPECT_EQ(fault_of(textured(red_and_blue().substr(0, 50))),
            "1 texture map, image 0, not carried: it is a damaged PNG; export it again");
  GlbBuilder outside = textured(red_and_blue());
  outside.document["images"][0] = {{"uri", "skin.png"}};
  EXPECT_EQ(fault_of(outside),
            "1 texture map, image 0, not carried: it is the file 'skin.png', which is not beside "
            "the mesh file; "
            "copy it there, or pack both in one zip");
}

TEST(ReadTexturedGlb, APictureInAnUnreadableViewIsNamedWithTheReason) {
  const std::string fault = "1 texture map, image 0, not carried: it cannot be read: glTF buffer ";
  GlbBuilder beyond = textured(red_and_blue());
  beyond.document["bufferViews"][2]["byteOffset"] = 1'000'000;
  EXPECT_EQ(fault_of(beyond), fault +
                                  "view 2 lies beyond the end of its buffer; the file is "
                                  "damaged, export it again");
  GlbBuilder elsewhere = textured(red_and_blue());
  elsewhere.document["buffers"] = {Json::object(), {{"uri", "skin.bin"}}};
  elsewhere.document["bufferViews"][2]["buffer"] = 1;
  EXPECT_EQ(fault_of(elsewhere), fault +
                                     "1 is the file 'skin.bin', which is not beside the mesh "
                                     "file; copy it there, or pack both in one zip");
}

// Adds an image stored in buffer view `view`, and a material and a primitive that use the image.
void add_image(GlbBuilder& builder, std::size_t view) {
  const std::size_t image = builder.append("images", {{"bufferView", view}});
  const std::size_t texture = builder.append("textures", {{"source", image}});
  Json& primitives = builder.document["meshes"][0]["primitives"];
  primitives.push_back(Json(primitives[0]));
  primitives.back()["material"] = builder.append(
      "materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
}

std::vector<std::string> repairs_within(const GlbBuilder& builder, std::uint64_t pixels) {
  const std::string file = builder.file();
  const auto result = read_mesh(as_bytes(file), {.limits = {.pixels = pixels}});
  EXPECT_TRUE(result) << result.error().message;
  return result ? result->repairs : std::vector<std::string>();
}

const std::string kBaked = "1 texture map baked into vertex colours; no step is needed";

TEST(ReadTexturedGlb, ADamagedPictureIsDecodedOnceForAllImagesInItsView) {
  const std::string damaged = red_and_blue().substr(0, 50);
  GlbBuilder builder = textured(damaged);
  for (int i = 0; i < 5; ++i)
    add_image(builder, 2);
  add_image(builder, builder.view(red_and_blue()));
  EXPECT_THAT(repairs_within(builder, damaged.size() + 4), Contains(kBaked));
}

TEST(ReadTexturedGlb, APictureOfAnExtensionIsToldByItsFormat) {
  GlbBuilder builder = textured("\xABKTX 20\xBB\r\n\x1A\n");
  builder.document["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  EXPECT_EQ(
      fault_of(builder),
      "1 texture map, image 0, not carried: it is image/ktx2; convert it to PNG, JPEG or WebP");
}

TEST(ReadTexturedGlb, AWebpGoesBeforeThePlainPicture) {
  GlbBuilder builder = textured("a plain picture that is not read");
  const std::string picture = webp_of({255, 0, 0, 0, 0, 255}, 2);
  builder.append("images", {{"bufferView", builder.view(picture)}, {"mimeType", "image/webp"}});
  builder.document["textures"][0]["extensions"]["EXT_texture_webp"] = {{"source", 1}};
  EXPECT_THAT(read_text(builder.file()).mesh.attributes.colours, ElementsAre(kRed, kBlue, kRed));
}

TEST(ReadTexturedGlb, ThePlainPictureGoesBeforeThatOfAnUnreadExtension) {
  GlbBuilder builder = textured(red_and_blue());
  builder.document["textures"][0]["extensions"]["KHR_texture_basisu"] = {{"source", 7}};
  EXPECT_THAT(read_text(builder.file()).mesh.attributes.colours, ElementsAre(kRed, kBlue, kRed));
}

// The picture red_and_blue() as a base64 data: URI.
const std::string kUri =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR42mP4zwAE/wEHAAH/"
    "PX2MSQAAAABJRU5ErkJggg==";

TEST(ReadTexturedGlb, APictureInADataUriIsRead) {
  GlbBuilder builder = textured("");
  builder.document["images"][0] = {{"uri", kUri}};
  EXPECT_THAT(read_text(builder.file()).mesh.attributes.colours, ElementsAre(kRed, kBlue, kRed));
}

TEST(ReadTexturedGlb, ADataUriThatCannotBeReadIsNamedAndTheMeshStays) {
  const std::string damaged = "1 texture map, image 0, not carried: it is ";
  const std::pair<std::string, std::string> faults[] = {
      {kUri.substr(0, 90), "a damaged PNG; export it again"},
      {kUri.substr(0, 60) + "*", "a data: URI that is not base64; export the file again"},
      {"data:image/png,%89PNG", "a data: URI that is not base64; export the file again"},
      {"data:", "a data: URI that is not base64; export the file again"}};
  for (const auto& [uri, fault] : faults) {
    GlbBuilder builder = textured("");
    builder.document["images"][0] = {{"uri", uri}};
    EXPECT_EQ(fault_of(builder), damaged + fault);
  }
}

TEST(ReadTexturedGlb, NamesMissingCoordinatesAndRefusesThoseThatDoNotMatch) {
  GlbBuilder missing = textured(red_and_blue());
  surface(missing)["baseColorTexture"]["texCoord"] = 1;
  EXPECT_THAT(read_text(missing.file()).repairs,
              ::testing::Contains(HasSubstr("1 primitive without the coordinates")));
  GlbBuilder short_by_one = textured(red_and_blue());
  short_by_one.document["accessors"][1]["count"] = 2;
  EXPECT_THAT(refusal(short_by_one.file()), HasSubstr("TEXCOORD_0 does not match POSITION"));
}

}  // namespace
}  // namespace vitrine
