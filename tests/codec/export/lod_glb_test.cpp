// SPDX-License-Identifier: Apache-2.0
// Tests GLB files with several levels of detail (MSFT_lod). tests/web/exports shows them in
// Babylon.js.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "codec/export/screen_coverage.h"
#include "codec/export/write_mesh.h"
#include "codec/import/mesh_builders.h"
#include "codec/import/read_mesh.h"
#include "codec/picture/write_picture.h"

namespace vitrine {
namespace {

using nlohmann::json;
using vitrine::testing::as_text;
using vitrine::testing::grid;

constexpr Compression kAllCompressions[] = {Compression::kNone, Compression::kMeshopt,
                                            Compression::kDraco};

// Returns a level whose mesh covers the same square as grid(16), with n x n squares.
CoarserLevel coarser_grid(std::uint32_t n, std::uint32_t number, double error) {
  CoarserLevel level{.mesh = grid(n), .level = number, .error = error, .grid = {{}, 16.0 / n}};
  for (Vec3& p : level.mesh.positions)
    p = p * (16.0 / n);
  return level;
}

json json_of(const std::vector<std::uint8_t>& glb) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, sizeof length);
  return json::parse(glb.begin() + 20, glb.begin() + 20 + length);
}

std::size_t faces_of(const json& file, std::size_t mesh) {
  std::size_t indices = 0;
  for (const json& primitive : file["meshes"][mesh]["primitives"])
    indices += file["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<int>();
  return indices / 3;
}

// Returns the material, and texture coordinates for each face of `mesh`.
Texturing red_texture(const TriangleMesh& mesh) {
  Texturing texturing;
  texturing.pictures = {{"a.png", write_png({1, 1, {255, 0, 0, 255}}).value()}};
  texturing.materials = {{.base_colour_map = TextureMap{}}};
  texturing.face_materials.assign(mesh.faces.size(), 0);
  texturing.coordinates[0].resize(mesh.faces.size());
  return texturing;
}

class LodGlb : public ::testing::Test {
 protected:
  std::vector<std::uint8_t> file(ExportOptions options = {}) {
    options.coarser = coarser_;
    auto bytes = write_mesh(grid(16), MeshFormat::kGlb, options);
    EXPECT_TRUE(bytes) << bytes.error().message;
    return bytes.value_or(std::vector<std::uint8_t>());
  }
  void expect_refused(Expected<std::vector<MeshFile>> files, const std::string& reason) {
    ASSERT_FALSE(files);
    EXPECT_THAT(files.error().message, ::testing::HasSubstr(reason));
  }

  std::vector<CoarserLevel> coarser_ = {coarser_grid(8, 3, 0.01), coarser_grid(2, 0, 1)};
};

TEST_F(LodGlb, HasANodeForEachLevelFromFineToCoarse) {
  for (const Compression compression : kAllCompressions) {
    const json glb =
        json_of(file({.about = {.title = "Bust", .level = 7}, .compression = compression}));
    EXPECT_EQ(glb["scenes"], json::parse(R"([{"nodes": [0]}])"));
    ASSERT_EQ(glb["nodes"].size(), 3u);
    EXPECT_EQ(glb["nodes"][0]["extensions"]["MSFT_lod"]["ids"], json({1, 2}));
    EXPECT_THAT(glb["extensionsUsed"], ::testing::Contains("MSFT_lod"));
    if (glb.contains("extensionsRequired")) {
      EXPECT_THAT(glb["extensionsRequired"], ::testing::Not(::testing::Contains("MSFT_lod")));
    }
    const std::size_t faces[] = {512, 128, 8};
    const char* names[] = {"Bust, level 7", "Bust, level 3", "Bust, level 0"};
    for (std::size_t m = 0; m < 3; ++m) {
      EXPECT_EQ(glb["nodes"][m]["mesh"], m);
      EXPECT_EQ(glb["nodes"][m].contains("extensions"), m == 0);
      EXPECT_EQ(faces_of(glb, m), faces[m]);
      EXPECT_EQ(glb["meshes"][m]["name"], names[m]);
    }
  }
}

TEST_F(LodGlb, IsReadAsItsFinestLevelByReadersThatDoNotKnowTheExtension) {
  for (const Compression compression : kAllCompressions) {
    const auto read = read_mesh(file({.compression = compression, .grid = ExportGrid{}}));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->mesh.faces.size(), 512u);
    EXPECT_EQ(bounds_of(read->mesh.positions).high, (Vec3{16, 16, 0}));
  }
}

TEST_F(LodGlb, HasTheDataOfTheCoarsestLevelFirst) {
  const json glb = json_of(file());
  std::size_t last = 0;
  for (const std::size_t m : {2u, 1u, 0u}) {
    const std::size_t accessor = glb["meshes"][m]["primitives"][0]["attributes"]["POSITION"];
    const std::size_t view = glb["accessors"][accessor]["bufferView"];
    const std::size_t offset = glb["bufferViews"][view]["byteOffset"];
    EXPECT_TRUE(m == 2 ? offset == 0 : offset > last);
    last = offset;
  }
}

TEST_F(LodGlb, HasAllLevelsInMetres) {
  const json glb = json_of(file({.unit = "mm"}));
  for (const json& mesh : glb["meshes"]) {
    const std::size_t accessor = mesh["primitives"][0]["attributes"]["POSITION"];
    EXPECT_FLOAT_EQ(glb["accessors"][accessor]["max"][0].get<float>(), 0.016F);
  }
  EXPECT_EQ(glb["nodes"][0]["extras"], json_of(file())["nodes"][0]["extras"]);
}

TEST_F(LodGlb, SharesOneMaterialAndItsPictures) {
  const TriangleMesh mesh = grid(16);
  for (CoarserLevel& level : coarser_)
    level.coordinates.resize(level.mesh.faces.size());
  for (const Compression compression : kAllCompressions) {
    const auto files = write_textured_mesh(mesh, red_texture(mesh), MeshFormat::kGlb, "a",
                                           {.compression = compression, .coarser = coarser_});
    ASSERT_TRUE(files) << files.error().message;
    const json glb = json_of(files->front().bytes);
    for (const char* shared : {"materials", "textures", "images"})
      EXPECT_EQ(glb[shared].size(), 1u) << shared;
    for (const json& level : glb["meshes"]) {
      EXPECT_EQ(level["primitives"][0]["material"], 0);
      EXPECT_TRUE(level["primitives"][0]["attributes"].contains("TEXCOORD_0"));
    }
    const std::size_t picture = glb["images"][0]["bufferView"];
    const std::size_t finest = compression == Compression::kDraco
                                   ? glb["bufferViews"].size() - 1
                                   : glb["accessors"][0]["bufferView"].get<std::size_t>();
    EXPECT_LT(picture, finest) << "the pictures come before the finer levels";
    const auto read = read_mesh(files->front().bytes);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->texturing.pictures.size(), 1u);
  }
}

TEST_F(LodGlb, IsAPlainFileWithoutCoarserLevels) {
  coarser_.clear();
  const auto plain = file();
  EXPECT_THAT(as_text(plain), ::testing::Not(::testing::HasSubstr("MSFT")));
  EXPECT_EQ(json_of(plain)["nodes"].size(), 1u);
}

TEST_F(LodGlb, RefusesLevelsThatDoNotFit) {
  const TriangleMesh mesh = grid(16);
  Texturing texturing = red_texture(mesh);
  const ExportOptions options{.coarser = coarser_};
  for (const ExportFormat& row : kExportFormats) {
    if (row.format == MeshFormat::kGlb) continue;
    expect_refused(write_textured_mesh(mesh, {}, row.format, "a", options),
                   "only GLB files hold several levels");
    EXPECT_FALSE(write_mesh(mesh, row.format, options)) << row.name;
  }
  expect_refused(write_textured_mesh(mesh, texturing, MeshFormat::kGlb, "a", options),
                 "the texture does not fit level 3");
  texturing.materials.resize(2);
  expect_refused(write_textured_mesh(mesh, texturing, MeshFormat::kGlb, "a", options),
                 "has one material");
  coarser_[0].coordinates.resize(coarser_[0].mesh.faces.size());
  EXPECT_FALSE(write_mesh(mesh, MeshFormat::kGlb, options)) << "coordinates without a texture";
  coarser_ = {CoarserLevel{}};
  EXPECT_FALSE(write_mesh(mesh, MeshFormat::kGlb, {.coarser = coarser_})) << "no faces";
}

TEST(ScreenCoverages, LetEachLevelStayUntilTheNextIsOffByLessThanAPixel) {
  const Bounds box{{0, 0, 0}, {3, 4, 0}};  // its diagonal is 5
  std::vector<CoarserLevel> levels(3);
  levels[0].error = 0.001;  // 1 pixel if the diagonal covers 5,000 pixels, more than a screen
  levels[1].error = 0.01;   // 1 pixel if the diagonal covers 500 pixels
  levels[2].error = 0.1;
  const auto shares = screen_coverages(box, levels);
  EXPECT_THAT(shares, ::testing::ElementsAre(1, ::testing::DoubleNear(0.0947, 1e-4),
                                             ::testing::DoubleNear(0.000947, 1e-6), 0));
  levels[1].error = 0;
  levels[2].error = 0.001;
  EXPECT_THAT(screen_coverages(box, levels), ::testing::ElementsAre(1, 1, 1, 0));
  EXPECT_THAT(screen_coverages(box, {}), ::testing::ElementsAre(0));
}

}  // namespace
}  // namespace vitrine
