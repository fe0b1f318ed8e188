// SPDX-License-Identifier: Apache-2.0
// Reads each file of the folder files, and compares all of the result with the right one.
#include <filesystem>
#include <map>
#include <set>

#include "cases/kind.h"
#include "support/meshes.h"

namespace vitrine {
namespace {

using vitrine::testing::kFourCases;
using vitrine::testing::kRedCase;

const std::filesystem::path kFolder = VITRINE_SOURCE_DIR "/tests/cases/files";

// The right result of a file: a mesh, or a refusal.
struct RightResult {
  std::string file;
  std::size_t faces = 4;
  std::vector<Colour> colours = {};       // of the vertices, in order
  std::vector<std::string> repairs = {};  // all lines
  std::string unit = "";
  std::string refused = "";  // the error; empty if there is none
};

// The means of the colours of three faces at each vertex: red, green, blue and ochre, without the
// colour of the face that does not touch the vertex. Means are taken in linear light.
const std::vector<Colour> kMeansOfFour{
    {192, 192, 0}, {156, 156, 156}, {192, 121, 156}, {121, 192, 156}};
const std::string kAveraged =
    "colours of 4 faces averaged at the vertices; bake them into a texture map to keep their "
    "borders sharp";

const std::vector<RightResult> kRightResults{
    {.file = "wings_pentagon.obj", .faces = 8},
    {.file = "count_2_of_4.stl",
     .repairs = {"4 facets read by the file's size, though its header counts 2; compare the model "
                 "with its source"}},
    {.file = "float255.ply",
     .colours = {{120, 80, 40}, {120, 81, 40}, {120, 82, 40}, {120, 83, 40}}},
    {.file = "colour_over_1.obj",
     .colours = kFourCases,
     .repairs = {"3 colour values above 1 clipped to 1; export colours from 0 to 1"}},
    {.file = "colour_rgba.obj",
     .colours = kFourCases,
     .repairs = {"opacity of 4 vertex colours not carried; set it in a material if it matters"}},
    {.file = "face_colour.ply", .colours = kMeansOfFour, .repairs = {kAveraged}},
    {.file = "face_colour.off", .colours = kMeansOfFour, .repairs = {kAveraged}},
    {.file = "cstoff.off",
     .colours = kFourCases,
     .repairs = {"4 texture coordinates not carried; OFF names no picture, so export the mesh as "
                 "GLB"}},
    {.file = "glued.off"},
    {.file = "end_loop.stl"},
    {.file = "qnan_normal.stl"},
    {.file = "colour.stl", .colours = std::vector(4, Colour{0, 0, 255})},
    {.file = "mrgb.obj", .colours = kFourCases},
    {.file = "map_kd.obj",
     .colours = std::vector(4, kRedCase),
     .repairs = {"1 texture map baked into vertex colours; no step is needed"}},
    {.file = "missing_material.obj",
     .repairs =
         {"1 texture coordinate not carried; to use them, name a material with a texture map",
          "1 material not in the material library, such as 'n'; faces that use it are "
          "uncoloured, so add it to the library"}},
    {.file = "int64.ply"},
    {.file = "comma.stl",
     .refused = "STL line 4: numbers have decimal commas; write them with points"},
    {.file = "units_in_world.ply"},
    {.file = "instancing_used.glb", .faces = 3420, .unit = "m"},
    {.file = "specular_glossiness_factor.glb",
     .faces = 1140,
     .colours = std::vector(572, Colour{255, 124, 0}),
     .repairs = {"the specular colours of 1 material not carried: only the diffuse colours are; "
                 "convert the materials to metallic-roughness",
                 "colours of 1 material baked into vertex colours; use texture maps to keep their "
                 "borders sharp"},
     .unit = "m"}};

std::string contents_of(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = test::file_bytes(path);
  return {bytes.begin(), bytes.end()};
}

// Returns the files beside the model: the material library and the picture.
std::map<std::string, std::string> libraries_and_pictures() {
  std::map<std::string, std::string> out;
  for (const std::string name : {"map_kd.mtl", "t.png"})
    out[name] = contents_of(kFolder / name);
  return out;
}

void expect_right(const RightResult& right) {
  SCOPED_TRACE(right.file);
  const auto read = testing::try_case({.situation = right.file,
                                       .file = contents_of(kFolder / right.file),
                                       .beside = libraries_and_pictures()});
  ASSERT_EQ(read ? "" : read.error().message, right.refused);
  if (!read) return;
  EXPECT_EQ(read->mesh.faces.size(), right.faces);
  EXPECT_EQ(read->mesh.attributes.colours, right.colours);
  EXPECT_EQ(read->repairs, right.repairs);
  EXPECT_EQ(read->unit, right.unit);
}

TEST(FilesOfCases, GiveTheRightResults) {
  for (const RightResult& right : kRightResults)
    expect_right(right);
}

TEST(FilesOfCases, AreAllInTheTable) {
  std::set<std::string> in_table{"map_kd.mtl", "t.png"}, in_folder;
  for (const RightResult& right : kRightResults)
    in_table.insert(right.file);
  for (const auto& entry : std::filesystem::directory_iterator(kFolder))
    in_folder.insert(entry.path().filename());
  EXPECT_EQ(in_folder, in_table);
}

}  // namespace
}  // namespace vitrine
