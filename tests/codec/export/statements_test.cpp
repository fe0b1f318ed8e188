// SPDX-License-Identifier: Apache-2.0
#include "codec/export/statements.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "codec/export/write_mesh.h"
#include "codec/import/mesh_builders.h"
#include "codec/import/read_mesh.h"

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using vitrine::testing::as_text;
using vitrine::testing::coloured_tetrahedron;

const FileDescription kBust = {.title = "Bust \"A\" \\ B",
                               .creator = "Ada",
                               .rights = "The museum",
                               .licence = "CC-BY-4.0",
                               .source = "https://museum.example/models/1",
                               .level = 3,
                               .error = 0.25};

std::string file_of(MeshFormat format, const ExportOptions& options) {
  const auto file = write_mesh(coloured_tetrahedron(), format, options);
  EXPECT_TRUE(file) << file.error().message;
  return file ? as_text(*file) : std::string();
}

ImportedMesh read_back(const std::string& file) {
  auto read = read_mesh({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
  EXPECT_TRUE(read) << read.error().message;
  return read ? std::move(*read) : ImportedMesh{};
}

TEST(Statements, APlyAndAnObjSayWhatTheyAreInComments) {
  for (const auto& [format, prefix] :
       {std::pair(MeshFormat::kPly, "\ncomment "), std::pair(MeshFormat::kObj, "\n# ")}) {
    const std::string file = file_of(format, {.unit = "mm", .up = UpAxis::kY, .about = kBust});
    for (const std::string line :
         {"unit mm", "up y", "title Bust \"A\" \\ B", "creator Ada", "rights The museum",
          "licence CC-BY-4.0", "source https://museum.example/models/1", "level 3",
          "error 0.25 mm"}) {
      EXPECT_THAT(file, HasSubstr(prefix + line + "\n"));
    }
  }
}

TEST(Statements, AVrmlSaysWhatItIsInItsWorldInfo) {
  const std::string file = file_of(MeshFormat::kVrml, {.unit = "mm", .about = kBust});
  EXPECT_THAT(file, HasSubstr("WorldInfo {\n  title \"Bust \\\"A\\\" \\\\ B\"\n"));
  EXPECT_THAT(file, HasSubstr("\n    \"creator Ada\",\n"));
  EXPECT_THAT(file, HasSubstr("\n    \"unit m\",\n"));
  EXPECT_THAT(file, HasSubstr("\n    \"error 0.00025 m\",\n"));
}

TEST(Statements, AGlbSaysWhatItIsInItsAssetAndNames) {
  const std::string file = file_of(MeshFormat::kGlb, {.unit = "mm", .about = kBust});
  const std::string title = R"("Bust \"A\" \\ B")";
  EXPECT_THAT(file, HasSubstr(R"("copyright":"Ada, The museum, CC-BY-4.0")"));
  EXPECT_THAT(file, HasSubstr(R"("extras":{"title":)" + title +
                              R"(,"author":"Ada","rights":"The museum","license":"CC-BY-4.0",)"
                              R"("source":"https://museum.example/models/1","level":3,)"
                              R"("error":0.00025,"unit":"m"})"));
  EXPECT_THAT(file, HasSubstr(R"("dc:creator":{"@list":["Ada"]})"));
  EXPECT_THAT(file, HasSubstr(R"("@value":)" + title));
  EXPECT_THAT(file, HasSubstr(R"("extensionsUsed":["KHR_xmp_json_ld"])"));
  EXPECT_THAT(file, HasSubstr(R"("nodes":[{"mesh":0,"name":)" + title));
  EXPECT_THAT(file, HasSubstr(R"("name":"Bust \"A\" \\ B, level 3"}])"));
  EXPECT_EQ(read_back(file).mesh.faces, coloured_tetrahedron().faces);
}

TEST(Statements, AnStlSaysWhatFitsAndIsNeverTakenForTextOrColours) {
  const std::string file =
      file_of(MeshFormat::kStl,
              {.unit = "mm", .about = {.title = "solid COLOR=abcd", .licence = "CC0-1.0"}});
  EXPECT_THAT(file, StartsWith("Vitrine, unit mm, solid COLOR:abcd, CC0-1.0"));
  const std::string cut =
      file_of(MeshFormat::kStl, {.unit = "mm", .about = {.title = std::string(62, 'a') + "ö"}});
  EXPECT_EQ(cut.substr(0, 80), "Vitrine, unit mm, " + std::string(62, 'a'))
      << "the first byte of ö would fit";
}

// Texts that would end a comment, add elements, continue a line, close a string or state a unit if
// writers did not escape them.
TEST(Statements, NoTextCanBreakAFile) {
  constexpr char kHostile[] =
      "\nend_header\nelement face 9\r\nf 1 2 3\0\x1b\x7f\xff\"]}{ units: in \\\n\\";
  const std::string hostile(kHostile, sizeof kHostile - 1);  // the text contains a zero byte
  const FileDescription about = {.title = hostile,
                                 .creator = hostile,
                                 .rights = "\xC2\x85 \u2028 f 1 2 3",
                                 .licence = hostile,
                                 .source = hostile + std::string(5000, 'x')};
  constexpr MeshFormat kNotRead[] = {MeshFormat::kDrc, MeshFormat::kVrml, MeshFormat::kUsdz};
  for (const ExportFormat& row : kExportFormats) {
    SCOPED_TRACE(row.name);
    const std::string file = file_of(row.format, {.about = about});
    EXPECT_THAT(file.substr(0, file.find("end_header\nv")), Not(HasSubstr("\nf 1 2 3")));
    if (row.format == MeshFormat::kVrml) {
      EXPECT_EQ(std::ranges::count(file, '\n'),
                std::ranges::count(file_of(row.format, {.about = {.title = "a",
                                                                  .creator = "a",
                                                                  .rights = "a",
                                                                  .licence = "a",
                                                                  .source = "a"}}),
                                   '\n'));
    }
    if (std::ranges::count(kNotRead, row.format) > 0) continue;
    const ImportedMesh read = read_back(file);
    EXPECT_EQ(read.mesh.faces.size(), coloured_tetrahedron().faces.size());
    EXPECT_EQ(read.mesh.positions.size(), coloured_tetrahedron().positions.size());
    EXPECT_EQ(read.unit, row.format == MeshFormat::kGlb   ? "m"
                         : row.format == MeshFormat::k3mf ? "mm"
                                                          : "");
  }
}

TEST(Statements, ALineIsShortAndCutBetweenCharacters) {
  EXPECT_EQ(one_line("  a\tb \\\\ "), "a b");
  EXPECT_EQ(one_line(" \\ "), "");
  std::string umlauts = "a";
  for (int i = 0; i < 300; ++i)
    umlauts += "ö";
  EXPECT_EQ(one_line(umlauts), umlauts.substr(0, 399));
}

TEST(Statements, AnUnknownUnitIsStated) {
  EXPECT_THAT(file_of(MeshFormat::kPly, {}), HasSubstr("\ncomment unit unknown\n"));
  EXPECT_THAT(file_of(MeshFormat::kStl, {.unit_in_file = "mm"}),
              StartsWith("Vitrine, unit unknown"));
  EXPECT_THAT(file_of(MeshFormat::kVrml, {}), HasSubstr("\"unit unknown\""));
  EXPECT_THAT(file_of(MeshFormat::kGlb, {}),
              HasSubstr(R"("unit":"unknown","note":"the unit of the model is unknown)"));
}

TEST(Statements, AFileHasTheUnitAndTheAxisThatAreChosen) {
  const std::string file =
      file_of(MeshFormat::kPly,
              {.unit = "m", .unit_in_file = "mm", .up = UpAxis::kZ, .about = {.error = 0.5}});
  EXPECT_THAT(file, HasSubstr("\ncomment up z\n"));
  EXPECT_THAT(file, HasSubstr("\ncomment error 500 mm\n"));
  const ImportedMesh read = read_back(file);
  EXPECT_EQ(read.unit, "mm");
  const TriangleMesh mesh = coloured_tetrahedron();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    EXPECT_EQ(read.mesh.positions[v], (Vec3{p.x, -p.z, p.y} * 1000));
  }
}

TEST(Statements, NormalsAreTurnedWithTheMesh) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  mesh.faces = {{0, 1, 2}};
  const auto file = write_mesh(mesh, MeshFormat::kObj, {.up = UpAxis::kZ});
  EXPECT_THAT(as_text(*file), HasSubstr("\nvn 0 0 1\n"));
}

TEST(Statements, FormatsWithAFixedUnitAndAxisTakeNoOther) {
  const TriangleMesh mesh = coloured_tetrahedron();
  for (const MeshFormat format : {MeshFormat::kGlb, MeshFormat::kVrml}) {
    EXPECT_FALSE(write_mesh(mesh, format, {.unit_in_file = "mm"}));
    EXPECT_FALSE(write_mesh(mesh, format, {.up = UpAxis::kZ}));
    EXPECT_TRUE(write_mesh(mesh, format, {.unit_in_file = "m", .up = UpAxis::kY}));
  }
}

}  // namespace
}  // namespace vitrine
