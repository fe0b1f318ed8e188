// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec/export/write_mesh.h"
#include "codec/import/mesh_builders.h"
#include "codec/import/read_mesh.h"
#include "support/packages/read_zip.h"

namespace vitrine {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using vitrine::testing::as_text;
using vitrine::testing::coloured_tetrahedron;
using vitrine::testing::grid;
using vitrine::testing::tetrahedron;

std::vector<std::uint8_t> bytes_of_3mf(const TriangleMesh& mesh,
                                       const ExportOptions& options = {}) {
  auto file = write_mesh(mesh, MeshFormat::k3mf, options);
  EXPECT_TRUE(file) << file.error().message;
  return file ? std::move(*file) : std::vector<std::uint8_t>();
}

std::string model_of(const TriangleMesh& mesh, const ExportOptions& options = {}) {
  return test::read_zip(as_text(bytes_of_3mf(mesh, options))).at("3D/3dmodel.model");
}

TEST(Write3mf, ReadsBackWithItsUnitAndColours) {
  const TriangleMesh mesh = coloured_tetrahedron();
  for (const std::string_view unit : {"mm", "cm", "m", "in"}) {
    const auto read = read_mesh(bytes_of_3mf(mesh, {.unit = unit}));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->unit, unit);
    EXPECT_EQ(read->mesh.positions, mesh.positions);
    EXPECT_EQ(read->mesh.faces, mesh.faces);
    EXPECT_EQ(read->mesh.attributes.colours, mesh.attributes.colours);
    EXPECT_THAT(read->repairs, IsEmpty()) << "the colours of a vertex are equal at all its faces";
  }
}

TEST(Write3mf, HasThePartsOfAPackage) {
  const auto parts = test::read_zip(as_text(bytes_of_3mf(tetrahedron())));
  EXPECT_EQ(parts.size(), 3u);
  EXPECT_THAT(parts.at("[Content_Types].xml"), HasSubstr("3dmanufacturing-3dmodel+xml"));
  EXPECT_THAT(parts.at("_rels/.rels"), HasSubstr("Target=\"/3D/3dmodel.model\""));
  EXPECT_THAT(parts.at("3D/3dmodel.model"), Not(HasSubstr("colorgroup")));
}

TEST(Write3mf, LeavesOutFacesThatRepeatAVertex) {
  TriangleMesh mesh = tetrahedron();
  const auto faces = mesh.faces;
  mesh.faces.insert(mesh.faces.begin(), {{1, 1, 2}, {1, 2, 2}, {2, 1, 2}});
  EXPECT_EQ(read_mesh(bytes_of_3mf(mesh))->mesh.faces, faces);
}

TEST(Write3mf, SaysWhatItIsInItsMetadata) {
  const std::string model = model_of(tetrahedron(), {.unit = "mm",
                                                     .about = {.title = "Bust",
                                                               .creator = "Ada",
                                                               .rights = "The museum",
                                                               .licence = "CC-BY-4.0",
                                                               .source = "https://a.example/1",
                                                               .level = 3,
                                                               .error = 0.25}});
  EXPECT_THAT(model, AllOf(HasSubstr("<metadata name=\"Title\">Bust</metadata>"),
                           HasSubstr("<metadata name=\"Designer\">Ada</metadata>"),
                           HasSubstr("<metadata name=\"Copyright\">The museum</metadata>"),
                           HasSubstr("<metadata name=\"LicenseTerms\">CC-BY-4.0</metadata>"),
                           HasSubstr("<metadata name=\"Description\">unit mm, up z, source "
                                     "https://a.example/1, level 3, error 0.25 mm</metadata>"),
                           HasSubstr(" name=\"Bust\"")));
}

TEST(Write3mf, NoTitleBreaksTheXml) {
  const std::string title = "\"><x y='1'>&amp;]]>\n<!-- \xC3\xB6 \xEF\xBF\xBE\xEF\xBF\xBF\x01 -->";
  const ExportOptions options = {.about = {.title = title, .creator = title, .source = title}};
  const std::string model = model_of(tetrahedron(), options);
  EXPECT_THAT(model,
              HasSubstr("&quot;&gt;&lt;x y=&#39;1&#39;&gt;&amp;amp;]]&gt; &lt;!-- \xC3\xB6"));
  EXPECT_THAT(model, Not(HasSubstr("\xEF\xBF\xBE")));
  EXPECT_THAT(model, Not(HasSubstr("\xEF\xBF\xBF")));
  const auto read = read_mesh(bytes_of_3mf(tetrahedron(), options));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->mesh.faces, tetrahedron().faces);
}

TEST(Write3mf, AnUnknownUnitIsNotStated) {
  const std::string model = model_of(tetrahedron());
  EXPECT_THAT(model, Not(HasSubstr(" unit=\"")));
  EXPECT_THAT(model, HasSubstr("unit unknown"));
}

TEST(Write3mf, HasZUpInAnyUnit) {
  EXPECT_THAT(model_of(tetrahedron(), {.unit = "m", .unit_in_file = "mm"}),
              HasSubstr(" z=\"1000\"/>"));
  const auto refused = write_mesh(tetrahedron(), MeshFormat::k3mf, {.up = UpAxis::kY});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "3MF files have z up; choose this, or another format");
}

}  // namespace
}  // namespace vitrine
