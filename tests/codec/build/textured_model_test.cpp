// SPDX-License-Identifier: Apache-2.0
// Builds a textured model, and tests what verification finds and what exports contain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "codec/build/atlas_footprint.h"
#include "codec/build/build_model.h"
#include "codec/build/charts.h"
#include "codec/build/exported_texture.h"
#include "codec/build/face_set.h"
#include "codec/build/open_model.h"
#include "codec/build/originals.h"
#include "codec/build/verify_model.h"
#include "codec/export/write_mesh.h"
#include "codec/import/read_mesh.h"
#include "codec/picture/decode_picture.h"
#include "support/product_names.h"
#include "support/textured_mesh.h"

namespace vitrine::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::HasSubstr;

const Bytes& textured() {
  static const Bytes file =
      build_model(textured_torus(60, 30, 512), {.region_vertices = 300}, {}).value().file;
  return file;
}

Expected<Verification> verify(const Bytes& file) {
  return verify_model(file, std::nullopt, [](auto, auto) {});
}

// Replaces the header of `file` by one written from `manifest`. The lengths in `manifest` must fit
// the body of the file.
Bytes with_manifest(Manifest manifest, const Bytes& file) {
  const std::uint64_t body = parse_header(file).value().base_offset;
  Bytes out = write_header(manifest);
  out.insert(out.end(), file.begin() + static_cast<std::ptrdiff_t>(body), file.end());
  return out;
}

TEST(TexturedModel, IsIntactInAllLevelsAndOrders) {
  const auto verified = verify(textured());
  ASSERT_TRUE(verified) << verified.error().message;
  EXPECT_GE(verified->pictures, 2u);
  EXPECT_GT(verified->orders, 1u);
  EXPECT_EQ(verified->faces, 3'600u);
  EXPECT_GE(chart_count(open_model(textured()).value()), 1u);
}

TEST(TexturedModel, TheAtlasCostsLessThanTwoBytesForAWedge) {
  const Manifest manifest = parse_header(textured()).value();
  const std::uint32_t wedges = open_model(textured()).value().wedges().size();
  EXPECT_LT(manifest.texture.atlas_length, 2 * wedges);
}

TEST(TexturedModel, ABaseMeshThatHandlesKeepLargeGetsNoTexture) {
  EncodedModel model;
  model.base.faces.resize(20'001);
  const auto atlas = place_atlas(model);
  ASSERT_FALSE(atlas);
  EXPECT_EQ(atlas.error().code, ErrorCode::kLimit);
  EXPECT_THAT(atlas.error().message, HasSubstr("20001 triangles in the base mesh"));
}

TEST(TexturedModel, APictureThatIsChangedOrCutOffIsFound) {
  const Manifest manifest = parse_header(textured()).value();
  for (const PictureInfo& picture : manifest.texture.pictures) {
    Bytes changed = textured();
    changed[picture.offset + picture.length / 2] ^= 1;
    const auto verified = verify(changed);
    ASSERT_FALSE(verified);
    EXPECT_THAT(verified.error().message, HasSubstr("of the texture"));
  }
  Bytes cut = textured();
  cut.pop_back();
  EXPECT_FALSE(verify(cut));
}

TEST(TexturedModel, APictureOfAnotherSideOrFormatIsFound) {
  Manifest manifest = parse_header(textured()).value();
  ++manifest.texture.pictures[0].side;
  const auto larger = verify(with_manifest(manifest, textured()));
  ASSERT_FALSE(larger);
  EXPECT_THAT(larger.error().message, HasSubstr("the header says"));

  manifest = parse_header(textured()).value();
  Bytes other = textured();
  PictureInfo& picture = manifest.texture.pictures[0];
  other[picture.offset] = 'x';
  picture.sha256 = sha256(std::span(other).subspan(picture.offset, picture.length));
  const auto no_webp = verify(with_manifest(manifest, other));
  ASSERT_FALSE(no_webp);
  EXPECT_THAT(no_webp.error().message, HasSubstr("is not WebP"));
}

TEST(TexturedModel, CoordinatesOutsideThePictureAreFound) {
  Manifest manifest = parse_header(textured()).value();
  manifest.texture.side = 16;
  const auto verified = verify(with_manifest(manifest, textured()));
  ASSERT_FALSE(verified);
  EXPECT_THAT(verified.error().message, HasSubstr("outside the picture"));
}

TEST(TexturedModel, ThePictureThatFitsIsChosen) {
  Manifest manifest;
  manifest.levels = {{.faces = 1'000}, {.faces = 100'000}};
  manifest.texture.side = 4096;
  for (const std::uint32_t side : {128u, 512u, 2048u})
    for (const PictureRole role : {PictureRole::kBaseColour, PictureRole::kNormal})
      manifest.texture.pictures.push_back({.role = role, .side = side});
  using Numbers = std::vector<std::size_t>;
  EXPECT_EQ(pictures_to_export(manifest, 1'000, {}), (Numbers{0, 1}));
  EXPECT_EQ(pictures_to_export(manifest, 2'000, {}), (Numbers{2, 3}));
  EXPECT_EQ(pictures_to_export(manifest, 100'000, {}), (Numbers{4, 5}));
  EXPECT_EQ(pictures_to_export(manifest, 100'000, 2047), (Numbers{2, 3}));
  EXPECT_EQ(pictures_to_export(manifest, 1'000, 16'384), (Numbers{4, 5}));
  EXPECT_EQ(pictures_to_export(manifest, 1'000, 64), (Numbers{0, 1}));
  EXPECT_EQ(pictures_to_export(manifest, 1'000, 0), Numbers{});
}

// Exports a level as GLB and reads the GLB back.
ImportedMesh exported(std::uint32_t level) {
  Refiner refiner = open_model(textured()).value();
  const Manifest& manifest = refiner.manifest();
  EXPECT_TRUE(refine(refiner, WantLevel{level}, chunks_of(manifest, textured())));
  const auto numbers = pictures_to_export(manifest, refiner.face_count(), {});
  const auto texturing = texturing_to_export(
      refiner, numbers, [&](std::size_t i) { return picture_of(manifest, textured(), i); });
  EXPECT_TRUE(texturing) << texturing.error().message;
  const auto glb = write_textured_mesh(refiner.display_mesh(), *texturing, MeshFormat::kGlb, "a");
  EXPECT_TRUE(glb) << glb.error().message;
  auto read = read_mesh(glb->front().bytes);
  EXPECT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->mesh.faces.size(), refiner.face_count());
  EXPECT_EQ(read->texturing.coordinates[0], refiner.texture_coordinates());
  return std::move(*read);
}

TEST(TexturedModel, TheGlbOfALevelHasItsCoordinatesAndAPictureThatFits) {
  const Manifest manifest = parse_header(textured()).value();
  const auto finest = static_cast<std::uint32_t>(manifest.levels.size() - 1);
  std::uint32_t side = 0;
  for (const std::uint32_t level : {0u, finest}) {
    const Texturing texturing = exported(level).texturing;
    ASSERT_EQ(texturing.pictures.size(), 1u);
    ASSERT_EQ(texturing.materials.size(), 1u);
    EXPECT_TRUE(texturing.materials[0].base_colour_map);
    const auto picture = decode_picture(texturing.pictures[0].bytes, 1 << 24).value();
    EXPECT_GT(picture.width, side) << "a finer level has a larger picture";
    side = picture.width;
  }
}

// Returns a torus as GLB. Its two halves have different materials. One picture uses the first set
// of texture coordinates. The other picture uses the second set, whose coordinates exceed 1. `move`
// is added to u at the first corner of the first face.
Bytes source_glb(float move = 0) {
  ImportedMesh source = textured_torus(60, 30, 64);
  Texturing& t = source.texturing;
  t.coordinates[0][0][0][0] += move;
  t.pictures.push_back(
      {"other.png", std::move(textured_torus(3, 3, 32).texturing.pictures[0].bytes)});
  t.coordinates[1] = t.coordinates[0];
  for (auto& face : t.coordinates[1]) {
    for (auto& [u, v] : face)
      u = 3 * u - 1, v = v / 3;
  }
  Material other{.name = "glaze \"2\"", .base_colour = {0.5, 1, 0.25, 1}, .metallic = 0.5};
  other.base_colour_map = {.picture = 1, .coordinates = 1, .wrap_v = Wrap::kMirror};
  other.base_colour_map->transform = {.offset = {0.5, 0.25}, .scale = {2, 3}, .rotation = 0.125};
  other.emission = {2, 0, 1};
  t.materials.push_back(other);
  for (std::size_t f = 0; f < t.face_materials.size(); f += 1 + f / 900)
    t.face_materials[f] = 1;
  return write_textured_mesh(source.mesh, t, MeshFormat::kGlb, "torus").value().front().bytes;
}

Refiner at_full_resolution(const Bytes& file) {
  Refiner refiner = open_model(file).value();
  EXPECT_TRUE(refine(refiner, WantLevel{63}, chunks_of(refiner.manifest(), file)));
  return refiner;
}

TEST(Originals, OfASourceAreVerifiedAgainstItToTheBit) {
  Bytes glb = source_glb();
  const Bytes file = build_model(glb, {.region_vertices = 300}).value().file;
  const auto verified = verify_model(file, OriginalFile{glb}, [](auto, auto) {});
  ASSERT_TRUE(verified) << verified.error().message;
  EXPECT_TRUE(verified->has_originals);
  EXPECT_TRUE(verified->is_lossless.value());

  glb = source_glb(std::nextafter(0.0F, 1.0F));
  const auto other = verify_model(file, OriginalFile{glb}, [](auto, auto) {});
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_FALSE(other->is_lossless.value());
}

TEST(Originals, AreInAGlbAsInTheSource) {
  const Bytes glb = source_glb();
  const Bytes file = build_model(glb, {.region_vertices = 300}).value().file;
  const Refiner refiner = at_full_resolution(file);
  const auto originals = originals_of(refiner, file);
  ASSERT_TRUE(originals) << originals.error().message;
  EXPECT_EQ(originals->materials.size(), 2u);
  const auto out =
      write_textured_mesh(refiner.display_mesh(), *originals, MeshFormat::kGlb, "torus");
  ASSERT_TRUE(out) << out.error().message;
  const ImportedMesh before = read_mesh(glb).value();
  const ImportedMesh after = read_mesh(out->front().bytes).value();
  EXPECT_TRUE(have_same_materials(before.texturing, after.texturing));
  const Lattice& lattice = refiner.manifest().lattice;
  EXPECT_EQ(source_face_set(quantise(before.mesh, lattice), before.texturing),
            source_face_set(quantise(after.mesh, lattice), after.texturing));
}

TEST(Originals, CostLessThanAPairOfFloatsForAVertex) {
  const Manifest manifest = parse_header(textured()).value();
  ASSERT_EQ(manifest.optional_blocks.size(), 2u);
  EXPECT_LT(manifest.optional_blocks[0].length, 1'800u * 8);
}

TEST(Originals, NeedFullResolution) {
  const Bytes file = build_model(source_glb(), {}).value().file;
  const auto coarse = originals_of(open_model(file).value(), file);
  ASSERT_FALSE(coarse);
  EXPECT_EQ(coarse.error().code, ErrorCode::kState);
}

TEST(Originals, ThatAreDamagedOrCutOffAreFound) {
  const Bytes file = build_model(source_glb(), {}).value().file;
  const Manifest manifest = parse_header(file).value();
  for (const OptionalBlock& block : manifest.optional_blocks) {
    Bytes changed = file;
    changed[block.offset + block.length / 2] ^= 1;
    const auto verified = verify(changed);
    ASSERT_FALSE(verified);
    EXPECT_THAT(verified.error().message, HasSubstr("optional block"));
  }
}

}  // namespace
}  // namespace vitrine::test
