// SPDX-License-Identifier: Apache-2.0
// Tests compressed GLB files, and that all GLB files store numbers with as few bits as possible.
// Vitrine's own reader decompresses the files here; tests/web/exports decompresses them with
// three.js.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "codec/export/write_mesh.h"
#include "codec/import/mesh_builders.h"
#include "codec/import/read_mesh.h"
#include "codec/picture/write_picture.h"

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using vitrine::testing::as_text;
using vitrine::testing::grid;

constexpr Compression kCompressions[] = {Compression::kMeshopt, Compression::kDraco};

// Returns a wavy sheet whose positions are points of a grid, each vertex with its own colour.
TriangleMesh sheet(const ExportGrid& lattice, double height) {
  TriangleMesh mesh = grid(20);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    const double x = std::round(p.x), y = std::round(p.y);
    p = lattice.origin +
        Vec3{x * 7, y * 5, std::round(height * (1 + std::sin(0.3 * static_cast<double>(v))))} *
            lattice.step;
    mesh.attributes.colours.push_back(
        {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v >> 8), 9});
  }
  return mesh;
}

std::string file_of(const TriangleMesh& mesh, const ExportOptions& options) {
  const auto file = write_mesh(mesh, MeshFormat::kGlb, options);
  EXPECT_TRUE(file) << file.error().message;
  return file ? as_text(*file) : std::string();
}

ImportedMesh read_glb_file(const std::string& file) {
  auto read = read_mesh({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
  EXPECT_TRUE(read) << read.error().message;
  return read ? std::move(*read) : ImportedMesh{};
}

// Expects the same faces and vertices, possibly in another order. Each position may be off by up to
// `distance` along each axis. Colours identify the vertices.
void expect_same(const TriangleMesh& found, const TriangleMesh& mesh, double distance) {
  std::map<Colour, std::uint32_t> by_colour;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    by_colour[mesh.attributes.colours[v]] = v;
  ASSERT_EQ(by_colour.size(), mesh.positions.size());
  ASSERT_EQ(found.positions.size(), mesh.positions.size());
  const auto old = [&](std::uint32_t v) { return by_colour.at(found.attributes.colours[v]); };
  for (std::uint32_t v = 0; v < found.positions.size(); ++v) {
    const Vec3 moved = found.positions[v] - mesh.positions[old(v)];
    EXPECT_LE(std::max({std::abs(moved.x), std::abs(moved.y), std::abs(moved.z)}), distance);
  }
  std::map<Triangle, int> faces;
  const auto add = [&](Triangle face, int count) {
    std::rotate(face.begin(), std::ranges::min_element(face), face.end());
    faces[face] += count;
  };
  for (const Triangle& face : mesh.faces)
    add(face, 1);
  for (const Triangle& face : found.faces)
    add({old(face[0]), old(face[1]), old(face[2])}, -1);
  EXPECT_TRUE(std::ranges::all_of(faces, [](const auto& one) { return one.second == 0; }));
}

TEST(CompressedGlb, KeepsPointsOfTheGrid) {
  const ExportGrid lattice{.origin = {3, -4, 5}, .step = 0.25};
  const TriangleMesh mesh = sheet(lattice, 1000);
  const std::string plain = file_of(mesh, {});
  for (const Compression compression : kCompressions) {
    const std::string file = file_of(mesh, {.compression = compression, .grid = lattice});
    expect_same(read_glb_file(file).mesh, mesh, 1e-4 * lattice.step);
    EXPECT_LT(file.size(), plain.size() / 2);
  }
}

TEST(CompressedGlb, RoundsOtherPointsToTheNearestOfTheGrid) {
  const ExportGrid lattice{.origin = {0.1, 0.2, 0.3}, .step = 0.5};
  const TriangleMesh mesh = sheet({.origin = {0.31, -7.7, 0.01}, .step = 0.013}, 500);
  for (const Compression compression : kCompressions) {
    const std::string file = file_of(mesh, {.compression = compression, .grid = lattice});
    expect_same(read_glb_file(file).mesh, mesh, 0.5001 * lattice.step);
  }
}

TEST(CompressedGlb, RoundsToAGridThatIsTooFineFor16Bits) {
  const ExportGrid lattice{.origin = {1, 2, 3}, .step = 1.0 / 1024};
  const TriangleMesh mesh = sheet(lattice, 300'000);
  for (const Compression compression : kCompressions) {
    const std::string file = file_of(mesh, {.compression = compression, .grid = lattice});
    expect_same(read_glb_file(file).mesh, mesh, 0.5001 * lattice.step);
    EXPECT_LT(file.size(), file_of(mesh, {.compression = compression}).size());
  }
  EXPECT_THAT(file_of(mesh, {.compression = Compression::kMeshopt, .grid = lattice}),
              HasSubstr("EXPONENTIAL"));
}

TEST(CompressedGlb, HasItsGridInMetres) {
  const ExportGrid lattice{.origin = {0, 0, 0}, .step = 0.25};
  TriangleMesh mesh = sheet(lattice, 100);
  for (const Compression compression : kCompressions) {
    const std::string file =
        file_of(mesh, {.unit = "mm", .compression = compression, .grid = lattice});
    TriangleMesh metres = mesh;
    for (Vec3& p : metres.positions)
      p = p * 0.001;
    expect_same(read_glb_file(file).mesh, metres, 1e-3 * 0.001 * lattice.step);
  }
}

TEST(CompressedGlb, WithoutAGridMeshoptIsExactAndDracoHas24Bits) {
  const TriangleMesh mesh = sheet({.origin = {0, 0, 0}, .step = 0.0625}, 1000);
  expect_same(read_glb_file(file_of(mesh, {.compression = Compression::kMeshopt})).mesh, mesh, 0);
  expect_same(read_glb_file(file_of(mesh, {.compression = Compression::kDraco})).mesh, mesh,
              125.0 / (1 << 23));
}

TEST(CompressedGlb, HoldsATexture) {
  const TriangleMesh mesh = grid(8);
  Texturing texturing;
  texturing.pictures = {{"a.png", write_png({1, 1, {255, 0, 0, 255}}).value()}};
  texturing.materials = {{.base_colour_map = TextureMap{}}};
  texturing.face_materials.assign(mesh.faces.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto at = static_cast<float>(f) / 256;
    texturing.coordinates[0].push_back({{{at, 0}, {at, 0.3F}, {0.3F, at}}});
  }
  for (const Compression compression : kCompressions) {
    const auto files =
        write_textured_mesh(mesh, texturing, MeshFormat::kGlb, "a", {.compression = compression});
    ASSERT_TRUE(files) << files.error().message;
    const ImportedMesh back = read_glb_file(as_text(files->front().bytes));
    ASSERT_EQ(back.texturing.pictures.size(), 1u);
    EXPECT_EQ(back.texturing.pictures[0].bytes, texturing.pictures[0].bytes);
    double sum = 0, expected = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        sum += back.texturing.coordinates[0].at(f)[k][0];
        expected += texturing.coordinates[0][f][k][0];
      }
    }
    EXPECT_NEAR(sum, expected, 3.0 * static_cast<double>(mesh.faces.size()) / 65535);
  }
  texturing.materials.resize(2);
  EXPECT_TRUE(write_textured_mesh(mesh, texturing, MeshFormat::kGlb, "a"));
  EXPECT_FALSE(write_textured_mesh(mesh, texturing, MeshFormat::kGlb, "a",
                                   {.compression = Compression::kDraco}));
}

TEST(CompressedGlb, IsTheOnlyCompressedFormat) {
  for (const ExportFormat& row : kExportFormats) {
    EXPECT_EQ(write_mesh(grid(2), row.format, {.compression = Compression::kDraco}).has_value(),
              row.format == MeshFormat::kGlb);
  }
}

TEST(CompressedGlb, RequiresItsExtensions) {
  const TriangleMesh mesh = grid(2);
  EXPECT_THAT(file_of(mesh, {.compression = Compression::kDraco}),
              HasSubstr(R"("extensionsRequired":["KHR_draco_mesh_compression"])"));
  EXPECT_THAT(
      file_of(mesh, {.compression = Compression::kMeshopt, .grid = ExportGrid{}}),
      HasSubstr(R"("extensionsRequired":["EXT_meshopt_compression","KHR_mesh_quantization"])"));
  EXPECT_THAT(file_of(mesh, {}), Not(HasSubstr("extensionsRequired")));
}

TEST(WriteGlb, IndicesHave16BitsIfTheseSuffice) {
  EXPECT_THAT(file_of(grid(2), {}), HasSubstr(R"("componentType":5123,"type":"SCALAR")"));
  const TriangleMesh large = grid(256);
  ASSERT_GT(large.positions.size(), 65'535u);
  const std::string file = file_of(large, {});
  EXPECT_THAT(file, HasSubstr(R"("componentType":5125,"type":"SCALAR")"));
  EXPECT_EQ(read_glb_file(file).mesh.faces, large.faces);
}

TEST(WriteGlb, ColoursHave8BitsIfTheseRestoreThem) {
  TriangleMesh mesh = grid(2);
  mesh.attributes.colours.assign(mesh.positions.size(), {255, 0, 188});
  const std::string light = file_of(mesh, {});
  EXPECT_THAT(light, HasSubstr(R"("componentType":5121,"normalized":true,"type":"VEC4")"));
  EXPECT_EQ(read_glb_file(light).mesh.attributes.colours, mesh.attributes.colours);
  mesh.attributes.colours[1] = {3, 4, 5};  // all three become 0 in 8 bits of linear light
  const std::string dark = file_of(mesh, {});
  EXPECT_THAT(dark, HasSubstr(R"("componentType":5123,"normalized":true,"type":"VEC4")"));
  EXPECT_EQ(read_glb_file(dark).mesh.attributes.colours, mesh.attributes.colours);
}

}  // namespace
}  // namespace vitrine
