// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "codec/core/srgb.h"
#include "codec/export/write_mesh.h"
#include "codec/import/mesh_builders.h"
#include "codec/mesh/vertex_normals.h"
#include "codec/picture/write_picture.h"
#include "support/packages/read_zip.h"
#include "support/read_export.h"

namespace vitrine {
namespace {

using test::usd_list;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using vitrine::testing::as_text;
using vitrine::testing::coloured_tetrahedron;
using vitrine::testing::grid;
using vitrine::testing::tetrahedron;

std::map<std::string, std::string> package_of(const TriangleMesh& mesh, const Texturing& texturing,
                                              const ExportOptions& options = {}) {
  const auto files = write_textured_mesh(mesh, texturing, MeshFormat::kUsdz, "cat", options);
  EXPECT_TRUE(files) << files.error().message;
  if (!files) return {};
  EXPECT_EQ(files->size(), 1u) << "the pictures are in the package";
  return test::read_zip(as_text(files->front().bytes));
}

std::string layer_of(const TriangleMesh& mesh, const ExportOptions& options = {}) {
  return package_of(mesh, {}, options)["model.usda"];
}

// Returns a material with four pictures. Every edge is a seam: adjacent faces have different
// texture coordinates at their common vertices.
Texturing four_pictures_with_seams(const TriangleMesh& mesh) {
  Texturing texturing;
  for (const char* name : {"base.png", "normal.png", "surface.png", "emission.png"})
    texturing.pictures.push_back({name, write_png({1, 1, {9, 9, 9, 255}}).value()});
  const auto map = [](std::uint32_t picture) {
    return TextureMap{.picture = picture, .wrap_u = Wrap::kClamp, .wrap_v = Wrap::kClamp};
  };
  texturing.materials = {{.base_colour_map = map(0),
                          .normal_map = map(1),
                          .metallic_roughness_map = map(2),
                          .occlusion_map = map(2),
                          .emission_map = map(3)}};
  texturing.face_materials.assign(mesh.faces.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto at = static_cast<float>(f) / 64;
    texturing.coordinates[0].push_back({{{at, 0}, {at, 0.5F}, {0.5F, at}}});
  }
  return texturing;
}

TEST(WriteUsdz, HoldsTheMeshItsNormalsAndItsColoursInLinearLight) {
  const TriangleMesh mesh = coloured_tetrahedron();
  const auto file = write_mesh(mesh, MeshFormat::kUsdz).value();
  const TriangleMesh back = test::read_export(file, MeshFormat::kUsdz);
  EXPECT_EQ(back.positions, mesh.positions);
  EXPECT_EQ(back.faces, mesh.faces);
  const std::string layer = layer_of(mesh);
  EXPECT_EQ(usd_list(layer, "int[] faceVertexCounts"), std::vector<double>(4, 3));
  EXPECT_EQ(usd_list(layer, "float3[] extent"), (std::vector<double>{0, 0, 0, 1, 1, 1}));
  const auto normals = usd_list(layer, "normal3f[] normals"),
             colours = usd_list(layer, "color3f[] primvars:displayColor");
  const std::vector<Vec3> expected = unit_normals(mesh);
  ASSERT_EQ(normals.size(), 12u);
  ASSERT_EQ(colours.size(), 12u);
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_NEAR(normals[3 * v + 2], expected[v].z, 1e-4);
    for (std::size_t k = 0; k < 3; ++k) {
      const double byte = linear_to_srgb(colours[3 * v + k]) * 255;
      EXPECT_NEAR(byte, mesh.attributes.colours[v][k], 1e-3);
    }
  }
  EXPECT_THAT(layer, HasSubstr("inputs:diffuseColor.connect = </model/material/colours.outputs:"));
  EXPECT_THAT(layer, Not(HasSubstr("xformOp")));
  EXPECT_THAT(layer_of(mesh, {.normals = Normals::kNone}), Not(HasSubstr("normal3f")));
}

TEST(WriteUsdz, TheLayerIsFirstAndAllFilesAreAligned) {
  const TriangleMesh mesh = grid(4);
  const auto files =
      write_textured_mesh(mesh, four_pictures_with_seams(mesh), MeshFormat::kUsdz, "cat");
  const std::string file = as_text(files.value().front().bytes);
  EXPECT_EQ(file.find("#usda 1.0"), 64u);
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = file.find("\x89PNG", at)) != file.npos; ++at, ++pictures)
    EXPECT_EQ(at % 64, 0u);
  EXPECT_EQ(pictures, 4u);
}

TEST(WriteUsdz, HoldsTheTextureWithCoordinatesForEachCorner) {
  TriangleMesh mesh = grid(4);
  mesh.attributes.colours.assign(mesh.positions.size(), {1, 2, 3});
  const Texturing texturing = four_pictures_with_seams(mesh);
  auto package = package_of(mesh, texturing);
  ASSERT_EQ(package.size(), 5u);
  EXPECT_EQ(package["cat_base.png"], as_text(texturing.pictures[0].bytes));
  const std::string& layer = package["model.usda"];
  EXPECT_THAT(layer, Not(HasSubstr("displayColor")));
  const auto points = usd_list(layer, "texCoord2f[] primvars:st"),
             corners = usd_list(layer, "int[] primvars:st:indices");
  ASSERT_EQ(corners.size(), 3 * mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = 2 * static_cast<std::size_t>(corners[3 * f + k]);
      EXPECT_NEAR(points.at(at), texturing.coordinates[0][f][k][0], 1e-6);
      EXPECT_NEAR(1 - points.at(at + 1), texturing.coordinates[0][f][k][1], 1e-6);
    }
  }
}

TEST(WriteUsdz, TheSurfaceTakesTheChannelsOfItsPictures) {
  const TriangleMesh mesh = grid(4);
  Texturing texturing = four_pictures_with_seams(mesh);
  const std::string layer = package_of(mesh, texturing)["model.usda"];
  for (const std::string connection :
       {"color3f inputs:diffuseColor.connect = </model/material/base_colour.outputs:rgb>",
        "normal3f inputs:normal.connect = </model/material/normal.outputs:rgb>",
        "float inputs:metallic.connect = </model/material/metallic_roughness.outputs:b>",
        "float inputs:roughness.connect = </model/material/metallic_roughness.outputs:g>",
        "float inputs:occlusion.connect = </model/material/occlusion.outputs:r>",
        "color3f inputs:emissiveColor.connect = </model/material/emission.outputs:rgb>",
        "asset inputs:file = @./cat_surface.png@", "token inputs:wrapS = \"clamp\"",
        "float4 inputs:bias = (-1, -1, -1, 0)"}) {
    EXPECT_THAT(layer, HasSubstr(connection + "\n"));
  }
  EXPECT_THAT(layer, Not(HasSubstr("opacity")));
  EXPECT_EQ(std::ranges::count(layer, '{'), std::ranges::count(layer, '}'));
  texturing.materials[0].alpha_mode = AlphaMode::kMask;
  texturing.materials[0].alpha_cutoff = 0.25;
  texturing.materials[0].metallic_roughness_map.reset();
  EXPECT_THAT(package_of(mesh, texturing)["model.usda"],
              AllOf(HasSubstr("inputs:opacity.connect = </model/material/base_colour.outputs:a>"),
                    HasSubstr("float inputs:opacityThreshold = 0.25\n"),
                    HasSubstr("float inputs:roughness = 1\n")));
  texturing.materials[0].base_colour_map.reset();
  texturing.materials[0].base_colour = {1, 0.5, 0.25, 1};
  EXPECT_THAT(package_of(mesh, texturing)["model.usda"],
              HasSubstr("color3f inputs:diffuseColor = (1, 0.5, 0.25)\n"));
}

TEST(WriteUsdz, StatesItsUnitItsAxisAndWhatItIs) {
  const std::string layer =
      layer_of(tetrahedron(),
               {.unit = "in", .unit_in_file = "cm", .up = UpAxis::kZ, .about = {.title = "Bust"}});
  EXPECT_THAT(layer, AllOf(StartsWith("#usda 1.0\n"), HasSubstr("    metersPerUnit = 0.01\n"),
                           HasSubstr("    upAxis = \"Z\"\n"), HasSubstr("    doc = \"Bust\"\n"),
                           HasSubstr("        string title = \"Bust\"\n"),
                           HasSubstr("        string unit = \"cm\"\n"), HasSubstr(",2.54)")));
  const std::string unknown = layer_of(tetrahedron());
  EXPECT_THAT(unknown, HasSubstr("    metersPerUnit = 1\n    upAxis = \"Y\"\n"));
  EXPECT_THAT(unknown, HasSubstr("        string unit = \"unknown\"\n"));
}

TEST(WriteUsdz, NoTextCanAddAStatement) {
  const std::string hostile = "Bust \"A\" \\ \"\n    upAxis = \"X\"\n)\n\xC3\xB6\\";
  const std::string layer =
      layer_of(tetrahedron(), {.about = {.title = hostile, .licence = hostile}});
  const std::string escaped = R"("Bust \"A\" \\ \"     upAxis = \"X\" ) )"
                              "\xC3\xB6\"\n";
  EXPECT_THAT(layer, HasSubstr("    doc = " + escaped));
  EXPECT_THAT(layer, HasSubstr("        string licence = " + escaped));
  const auto plain = layer_of(tetrahedron(), {.about = {.title = "a", .licence = "a"}});
  EXPECT_EQ(std::ranges::count(layer, '\n'), std::ranges::count(plain, '\n'));
}

TEST(WriteUsdz, FarFromTheOriginDetailIsKept) {
  TriangleMesh mesh = grid(16);
  for (Vec3& p : mesh.positions)
    p = p * (1.0 / 1024) + Vec3{500'000, 5'300'000, 250};
  const auto file = write_mesh(mesh, MeshFormat::kUsdz).value();
  EXPECT_EQ(test::read_export(file, MeshFormat::kUsdz).positions, mesh.positions);
}

}  // namespace
}  // namespace vitrine
