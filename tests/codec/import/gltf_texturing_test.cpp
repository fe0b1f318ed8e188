// SPDX-License-Identifier: Apache-2.0
// Tests which materials, pictures and texture coordinates a mesh keeps from glTF files.
#include "codec/import/textured_gltf.h"
#include "codec/picture/bitmaps.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using vitrine::testing::as_text;
using vitrine::testing::GlbBuilder;
using vitrine::testing::png_of;
using vitrine::testing::read_text;
using vitrine::testing::red_and_blue;
using vitrine::testing::textured;
using vitrine::testing::webp_of;
using Json = nlohmann::json;

using PlacesOfFace = std::array<TextureCoordinates, 3>;

TEST(GltfTexturing, CarriesThePictureAndTheCoordinatesOfTheCorners) {
  GlbBuilder builder = textured(red_and_blue());
  builder.document["images"][0]["name"] = "skin";
  const auto result = read_text(builder.file()).texturing;
  ASSERT_EQ(result.pictures.size(), 1u);
  EXPECT_EQ(as_text(result.pictures[0].bytes), red_and_blue());
  EXPECT_EQ(result.pictures[0].name, "skin");
  EXPECT_THAT(result.face_materials, ElementsAre(0));
  EXPECT_THAT(result.coordinates[0], ElementsAre(PlacesOfFace{{{0.25, 0}, {0.75, 0}, {1.25, 0}}}));
  EXPECT_THAT(result.coordinates[1], IsEmpty());
  const Material& material = result.materials.at(0);
  ASSERT_TRUE(material.base_colour_map);
  EXPECT_EQ(material.base_colour_map->wrap_u, Wrap::kRepeat);
  EXPECT_FALSE(material.base_colour_map->is_nearest);
  EXPECT_EQ(material.metallic, 1) << "glTF's own default";
}

TEST(GltfTexturing, CarriesAllPropertiesOfAMaterial) {
  GlbBuilder builder = textured(red_and_blue());
  builder.document["materials"][0] = Json::parse(R"({
    "name": "bronze", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
    "emissiveFactor": [0.5, 1, 0], "emissiveTexture": {"index": 0},
    "normalTexture": {"index": 0, "scale": 0.5}, "occlusionTexture": {"index": 0, "strength": 0.75},
    "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 0.125], "metallicFactor": 0.5,
      "roughnessFactor": 0.25, "metallicRoughnessTexture": {"index": 0},
      "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform":
        {"offset": [0.1, 0.2], "scale": [2, 3], "rotation": 0.5}}}},
    "extensions": {"KHR_materials_unlit": {},
                   "KHR_materials_emissive_strength": {"emissiveStrength": 4}}})");
  builder.document["samplers"][0] = {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}};
  const auto result = read_text(builder.file());
  const Material& material = result.texturing.materials.at(0);
  EXPECT_EQ(material.name, "bronze");
  EXPECT_THAT(material.base_colour, ElementsAre(1, 0.5, 0.25, 0.125));
  EXPECT_EQ(material.metallic, 0.5);
  EXPECT_EQ(material.roughness, 0.25);
  EXPECT_EQ(material.normal_scale, 0.5);
  EXPECT_EQ(material.occlusion_strength, 0.75);
  EXPECT_EQ(material.emission, (Vec3{2, 4, 0}));
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(material.alpha_cutoff, 0.25);
  EXPECT_TRUE(material.is_double_sided);
  EXPECT_TRUE(material.is_unlit);
  EXPECT_TRUE(material.normal_map && material.metallic_roughness_map && material.occlusion_map &&
              material.emission_map);
  const TextureMap& map = *material.base_colour_map;
  EXPECT_EQ(map.wrap_u, Wrap::kClamp);
  EXPECT_EQ(map.wrap_v, Wrap::kMirror);
  EXPECT_TRUE(map.is_nearest);
  EXPECT_THAT(map.transform.offset, ElementsAre(0.1, 0.2));
  EXPECT_THAT(map.transform.scale, ElementsAre(2, 3));
  EXPECT_EQ(map.transform.rotation, 0.5);
  EXPECT_THAT(result.texturing.pictures, SizeIs(1));
  EXPECT_THAT(result.repairs, Not(Contains(HasSubstr("extension"))));
}

TEST(GltfTexturing, NumbersOutOfRangeAreClamped) {
  GlbBuilder builder = textured(red_and_blue());
  builder.document["materials"][0]["pbrMetallicRoughness"].update(
      {{"metallicFactor", -1}, {"roughnessFactor", 1e300}, {"baseColorFactor", {2, -1, 0, 1}}});
  const Material material = read_text(builder.file()).texturing.materials.at(0);
  EXPECT_EQ(material.metallic, 0);
  EXPECT_EQ(material.roughness, 1);
  EXPECT_THAT(material.base_colour, ElementsAre(1, 0, 0, 1));
}

TEST(GltfTexturing, AMaterialWithoutPicturesIsKeptForItsRoughness) {
  const auto materials = [](double roughness) {
    GlbBuilder builder = textured(red_and_blue());
    builder.document["materials"][0]["pbrMetallicRoughness"] = {{"metallicFactor", 0},
                                                                {"roughnessFactor", roughness}};
    return read_text(builder.file()).texturing.materials;
  };
  EXPECT_THAT(materials(0.5), SizeIs(1));
  EXPECT_THAT(materials(1), SizeIs(0)) << "glTF's own default";
  EXPECT_THAT(materials(0.8), SizeIs(0)) << "what exports of meshes without textures say";
}

TEST(GltfTexturing, NormalisedCoordinatesAndASecondSetAreRead) {
  GlbBuilder builder = textured(red_and_blue());
  const std::size_t bytes = builder.accessor(
      "VEC2", 5121, 3,
      {{"bufferView", builder.view(std::string("\0\xFF\xFF\0\x33\x66", 6))}, {"normalized", true}});
  builder.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = bytes;
  builder.document["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
  const auto result = read_text(builder.file()).texturing;
  EXPECT_EQ(result.materials.at(0).normal_map->coordinates, 1);
  EXPECT_THAT(result.coordinates[1],
              ElementsAre(PlacesOfFace{{{0, 1}, {1, 0}, {0x33 / 255.F, 0x66 / 255.F}}}));
}

TEST(GltfTexturing, FacesOfSeveralPrimitivesHaveTheirMaterials) {
  GlbBuilder builder = textured(red_and_blue());
  builder.append("materials", {{"name", "metal"}});
  const Json attributes = builder.document["meshes"][0]["primitives"][0]["attributes"];
  const std::size_t points = builder.floats("VEC3", {5, 0, 0, 6, 0, 0, 5, 1, 0}, 3);
  Json& primitives = builder.document["meshes"][0]["primitives"];
  primitives.push_back({{"attributes", {{"POSITION", points}}}, {"material", 1}});
  primitives.push_back({{"attributes", {{"POSITION", points}}}});
  primitives.push_back({{"attributes", attributes}, {"material", 0}});
  const auto result = read_text(builder.file()).texturing;
  EXPECT_THAT(result.face_materials, ElementsAre(0, 1, 2, 0));
  EXPECT_EQ(result.materials.at(1).name, "metal");
  EXPECT_EQ(result.materials.at(2).metallic, 0) << "no material at all";
  const PlacesOfFace places{{{0.25, 0}, {0.75, 0}, {1.25, 0}}}, zeros{};
  EXPECT_THAT(result.coordinates[0], ElementsAre(places, zeros, zeros, places));
}

TEST(GltfTexturing, PicturesWithTheSameBytesAreCarriedOnce) {
  GlbBuilder builder = textured(red_and_blue());
  builder.append("images", {{"bufferView", builder.view(red_and_blue())}});
  builder.append("images", {{"bufferView", builder.view(webp_of({1, 2, 3}, 1))}});
  builder.append("textures", {{"source", 1}});
  builder.append("textures", {{"extensions", {{"EXT_texture_webp", {{"source", 2}}}}}});
  builder.document["materials"][0]["normalTexture"] = {{"index", 1}};
  builder.document["materials"][0]["occlusionTexture"] = {{"index", 2}};
  const auto result = read_text(builder.file()).texturing;
  EXPECT_THAT(result.pictures, SizeIs(2));
  EXPECT_EQ(result.materials.at(0).normal_map->picture, 0u);
  EXPECT_EQ(result.materials.at(0).occlusion_map->picture, 1u);
}

TEST(GltfTexturing, IsEmptyIfMaterialsAddNothingToColours) {
  GlbBuilder builder = textured(red_and_blue());
  builder.document["materials"][0] = {
      {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {1, 0.5, 0, 1}}}}};
  EXPECT_TRUE(read_text(builder.file()).texturing.empty());
  builder.document["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1;
  EXPECT_FALSE(read_text(builder.file()).texturing.empty());
}

TEST(GltfTexturing, APictureOfAnotherFormatIsLeftOutAndNamedOnce) {
  GlbBuilder builder = textured(red_and_blue());
  for (int i = 1; i <= 2; ++i) {
    builder.append("images", {{"bufferView", builder.view("\xABKTX 20\xBB" + std::to_string(i))}});
    builder.append("textures", {{"extensions", {{"KHR_texture_basisu", {{"source", i}}}}}});
  }
  builder.document["materials"][0]["normalTexture"] = {{"index", 1}};
  builder.document["materials"][0]["occlusionTexture"] = {{"index", 2}};
  const auto result = read_text(builder.file());
  EXPECT_FALSE(result.texturing.materials.at(0).normal_map);
  EXPECT_THAT(result.texturing.pictures, SizeIs(1));
  EXPECT_THAT(
      result.repairs,
      ElementsAre("1 texture map baked into vertex colours; no step is needed",
                  "2 texture maps, first image 1, not carried: it is image/ktx2; convert it "
                  "to PNG, JPEG or WebP"));
}

TEST(GltfTexturing, TiffBmpAndTgaAreKeptAsPng) {
  const std::vector<std::uint8_t> pixels{255, 0, 0, 0, 0, 255};
  for (const std::string& picture :
       {vitrine::testing::tiff_of(pixels), vitrine::testing::bmp_of(pixels, 2),
        vitrine::testing::tga_of(pixels, 2)}) {
    const auto read = read_text(textured(picture).file());
    EXPECT_EQ(read.mesh.attributes.colours,
              read_text(textured(red_and_blue()).file()).mesh.attributes.colours);
    ASSERT_THAT(read.texturing.pictures, SizeIs(1));
    EXPECT_TRUE(as_text(read.texturing.pictures[0].bytes).starts_with("\x89PNG"));
    EXPECT_THAT(read.repairs, Contains(HasSubstr("1 texture map kept as PNG")));
  }
}

TEST(GltfTexturing, WhatIsNotCarriedIsNamed) {
  GlbBuilder builder = textured(red_and_blue());
  builder.document["materials"][0]["extensions"] = {{"KHR_materials_clearcoat", Json::object()},
                                                    {"KHR_materials_sheen", Json::object()}};
  builder.document["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", 2}};
  const auto result = read_text(builder.file());
  EXPECT_THAT(result.repairs,
              Contains("2 material extensions not carried: 'KHR_materials_clearcoat', "
                       "'KHR_materials_sheen'; bake them into the base colour map"));
  EXPECT_THAT(result.repairs, Contains(HasSubstr("1 use of a texture map not carried")));
}

TEST(GltfTexturing, CoordinatesThatAreNotFiniteBecomeZero) {
  GlbBuilder builder = textured(red_and_blue());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  builder.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      builder.floats("VEC2", {nan, 0.5, 0.75, 0, 1.25, 0}, 3);
  const auto result = read_text(builder.file());
  EXPECT_EQ(result.texturing.coordinates[0].at(0)[0], (TextureCoordinates{0, 0.5}));
  EXPECT_THAT(result.repairs, Contains(HasSubstr("1 texture coordinate without finite values")));
}

// Many images can refer to the same bytes. If each image made a copy of these bytes, memory would
// not be bounded.
TEST(GltfTexturing, PicturesTogetherAreNotLargerThanTheFile) {
  std::string picture = red_and_blue();
  picture += std::string(2000, 'x');
  GlbBuilder builder = textured(picture + picture);
  const Json view = builder.document["bufferViews"][2];
  Json& material = builder.document["materials"][0];
  int index = 0;
  for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) {
    ++index;
    Json shorter = view;
    shorter["byteLength"] = view["byteLength"].get<std::size_t>() - static_cast<std::size_t>(index);
    builder.append("bufferViews", shorter);
    builder.append("images", {{"bufferView", builder.document["bufferViews"].size() - 1}});
    builder.append("textures", {{"source", index}});
    material[key] = {{"index", index}};
  }
  const auto result = read_text(builder.file());
  EXPECT_THAT(result.texturing.pictures, SizeIs(1));
  EXPECT_THAT(result.repairs,
              Contains(HasSubstr("brings all pictures together over their size limit")));
}

}  // namespace
}  // namespace vitrine
