// SPDX-License-Identifier: Apache-2.0
// Tests glTF files as text, with buffers and pictures in companion files or in data: URIs.
#include "codec/import/glb_builder.h"
#include "codec/picture/pictures.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vitrine::testing::as_bytes;
using vitrine::testing::GlbBuilder;
using vitrine::testing::kBlue;
using vitrine::testing::kRed;
using vitrine::testing::red_and_blue;

// Returns one triangle. Its corners are at u = 0.25, 0.75 and 1.25 of the picture "My skin.png".
GlbBuilder skinned() {
  GlbBuilder builder;
  const std::size_t points = builder.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  const std::size_t places = builder.floats("VEC2", {0.25, 0, 0.75, 0, 1.25, 0}, 3);
  builder.append("images", {{"uri", "maps/My%20skin.png"}});
  builder.append("textures", {{"source", 0}});
  builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  builder.mesh({{"attributes", {{"POSITION", points}, {"TEXCOORD_0", places}}}, {"material", 0}});
  return builder;
}

Expected<ImportedMesh> read_beside(const std::string& text,
                                   const std::map<std::string, std::string>& files,
                                   const Limits& limits = {}) {
  Companions beside;
  for (const auto& [name, contents] : files)
    beside[name] = as_bytes(contents);
  return read_mesh(as_bytes(text), {.limits = limits, .beside = beside});
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k > bytes.size() - i ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return out;
}

TEST(ReadGltf, BuffersAndPicturesBesideTheFileAreFoundByTheirDecodedNames) {
  const GlbBuilder builder = skinned();
  const auto result =
      read_beside(builder.text_file("B%C3%A9%20x.bin"),
                  {{"b\xC3\xA9 x.bin", builder.binary()}, {"my skin.png", red_and_blue()}});
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_THAT(result->mesh.attributes.colours, ElementsAre(kRed, kBlue, kRed));
  EXPECT_THAT(result->repairs,
              ElementsAre("1 texture map baked into vertex colours; no step is needed"));
  EXPECT_EQ(result->unit, "m");
}

TEST(ReadGltf, ABufferInADataUriIsReadAndDoesNotCountAsJson) {
  const GlbBuilder builder = skinned();
  const std::string data = "data:application/octet-stream;base64," + base64(builder.binary());
  std::string text = " \n" + builder.text_file(data);
  const std::uint64_t json_bytes = text.size() - data.size();
  EXPECT_TRUE(read_beside(text, {}, {.header_bytes = json_bytes}).has_value());
  EXPECT_THAT(read_beside(text, {}, {.header_bytes = json_bytes - 1}).error().message,
              HasSubstr("the glTF's JSON is"));
}

TEST(ReadGltf, AMissingFileIsNamedWithTheNextStep) {
  const GlbBuilder builder = skinned();
  EXPECT_EQ(read_beside(builder.text_file("a/b%20c.bin"), {}).error().message,
            "glTF buffer 0 is the file 'a/b c.bin', which is not beside the mesh file; copy it "
            "there, or pack both in one zip");
  const auto result = read_beside(builder.text_file("b.bin"), {{"b.bin", builder.binary()}});
  ASSERT_TRUE(result.has_value());
  EXPECT_THAT(result->repairs, ElementsAre(HasSubstr("it is the file 'maps/My skin.png', which")));
}

// The missing buffer holds the picture and the positions. The reader looks up the picture first,
// and must then report the missing buffer, too.
TEST(ReadGltf, AMissingBufferWithAPictureIsNamedToo) {
  GlbBuilder builder = skinned();
  builder.document["images"][0] = {{"bufferView", builder.view(red_and_blue())}};
  EXPECT_THAT(read_beside(builder.text_file("b.bin"), {}).error().message,
              HasSubstr("glTF buffer 0 is the file 'b.bin', which is not beside the mesh file"));
}

TEST(ReadGltf, ABufferThatIsTooShortOrHasNoDataIsRefused) {
  GlbBuilder builder = skinned();
  EXPECT_THAT(read_beside(builder.text_file("b.bin"), {{"b.bin", "1234"}}).error().message,
              HasSubstr("glTF accessor 0 does not fit its buffer view"));
  builder.document["bufferViews"][0]["buffer"] = 1;
  EXPECT_THAT(
      read_beside(builder.text_file("b.bin"), {{"b.bin", builder.binary()}}).error().message,
      HasSubstr("glTF buffer view 0 is in a buffer without data"));
}

TEST(ReadGltf, PercentSignsWithoutDigitsStay) {
  EXPECT_EQ(percent_decoded("a%2Fb%20%zz%4"), "a/b %zz%4");
}

TEST(ReadGltf, OtherJsonIsNoMesh) {
  EXPECT_THAT(read_beside("{\"a\": 1}", {}).error().message,
              HasSubstr("this is JSON that is not glTF"));
}

}  // namespace
}  // namespace vitrine
