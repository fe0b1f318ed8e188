// SPDX-License-Identifier: Apache-2.0
// Tests the numbers that the program prints for a level, such as counts and errors. These numbers
// must be true for the exported file as other software reads it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "codec/core/bounds.h"
#include "support/dense_distance.h"
#include "support/product_names.h"
#include "support/read_export.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;

TriangleMesh read_as(const std::string& bytes, MeshFormat format) {
  return read_export({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, format);
}

// Takes a fine grid of points on each surface. Returns the largest distance from such a point to
// the other surface.
double farthest(const TriangleMesh& a, const TriangleMesh& b) {
  return std::max(dense_maximum(a, TriangleBvh(b)), dense_maximum(b, TriangleBvh(a)));
}

TEST_F(VitrineCommand, TheErrorOfTheTableBoundsEveryExportOfEveryLevel) {
  const std::string in = write("in.ply", bumpy_ply(2'000));
  const TriangleMesh original = read_as(read("in.ply"), MeshFormat::kPly);
  for (const std::string bits : {"12", "15"}) {
    vitrine_json({"build", in, "-o", path("out.pmesh"), "--bits", bits, "--unit", "m"});
    const json levels = vitrine_json({"info", path("out.pmesh")})["levels"];
    ASSERT_GE(levels.size(), 3u);
    for (const std::string extension : {"ply", "glb", "obj", "stl", "drc", "wrl", "3mf", "usdz"}) {
      for (std::size_t level = 0; level < levels.size(); ++level) {
        SCOPED_TRACE(extension + " of level " + std::to_string(level) + ", " + bits + " bits");
        const double stated = levels[level]["max_error"].get<double>();
        const std::string out = "out." + extension;
        const std::string up = extension == "3mf" ? "z" : "y";  // read_export() turns 3MF to y up
        vitrine_json({"decode", path("out.pmesh"), "-o", path(out), "--unit", "m", "--up", up,
                      "--error", levels[level]["max_error"].dump()});
        const TriangleMesh mesh = read_as(read(out), *format_of_extension(extension));
        EXPECT_EQ(mesh.faces.size(), levels[level]["faces"]);
        const double found = farthest(mesh, original);
        EXPECT_LE(found, stated);
        EXPECT_GT(found, 0.5 * stated);
      }
    }
  }
}

TEST_F(VitrineCommand, AnExportHasTheUnitAndTheAxisOfItsFormatOrOfTheFlags) {
  const std::string in = write("in.ply", bumpy_ply(200));
  vitrine_json({"build", in, "-o", path("out.pmesh"), "--unit", "cm"});
  const auto decoded = [&](const std::string& out, std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"decode", path("out.pmesh"), "-o", path(out)});
    vitrine_json(flags);
    return bounds_of(read_as(read(out), *format_of_extension(out.substr(4))).positions);
  };
  const Bounds box = decoded("out.ply", {}), stl = decoded("out.stl", {});
  EXPECT_NEAR(stl.high.z, box.high.y * 10, 1e-3);
  EXPECT_NEAR(decoded("out.stl", {"--up", "y", "--unit", "cm"}).high.y, box.high.y, 1e-4);
  EXPECT_NEAR(decoded("out.obj", {"--up", "z", "--unit", "m"}).high.z, box.high.y / 100, 1e-4);
  EXPECT_THAT(read("out.obj"), ::testing::HasSubstr("# unit m\n# up z\n"));
  for (const std::string unit : {"mm", "furlong"})
    expect_fault(vitrine({"decode", path("out.pmesh"), "-o", path("out.glb"), "--unit", unit}), 2);
  expect_fault(vitrine({"decode", path("out.pmesh"), "-o", path("out.wrl"), "--up", "z"}), 2);
  expect_fault(vitrine({"decode", path("out.pmesh"), "-o", path("out.3mf"), "--up", "y"}), 2);
}

// At each level, the surface of a compressed file differs from that of a plain file by at most half
// a cell of the level's lattice along each axis.
TEST_F(VitrineCommand, ACompressedGlbIsWithinTheLatticeOfItsLevel) {
  const std::string in = write("in.ply", bumpy_ply(2'000));
  vitrine_json({"build", in, "-o", path("out.pmesh"), "--unit", "m"});
  const json info = vitrine_json({"info", path("out.pmesh")});
  const auto levels = static_cast<int>(info["levels"].size());
  for (int level = 0; level < levels; ++level) {
    const std::string number = std::to_string(level);
    vitrine_json({"decode", path("out.pmesh"), "-o", path("plain.glb"), "--level", number});
    const TriangleMesh plain = read_as(read("plain.glb"), MeshFormat::kGlb);
    for (const std::string name : {"meshopt", "draco"}) {
      vitrine_json({"decode", path("out.pmesh"), "-o", path("small.glb"), "--level", number,
                    "--compression", name});
      EXPECT_LT(read("small.glb").size(), read("plain.glb").size()) << name << number;
      const TriangleMesh small = read_as(read("small.glb"), MeshFormat::kGlb);
      EXPECT_EQ(small.faces.size(), plain.faces.size());
      const Bounds box = bounds_of(plain.positions);
      const double most = box.longest_side() * (level + 1 == levels ? 1e-6 : 0.03);
      EXPECT_LT(farthest(small, plain), most) << name << number;
    }
  }
  expect_fault(
      vitrine({"decode", path("out.pmesh"), "-o", path("a.ply"), "--compression", "draco"}), 2);
}

// Returns the JSON of a GLB file.
json json_of_glb(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof size);
  return json::parse(glb.substr(20, size));
}

TEST_F(VitrineCommand, AGlbHoldsCoarserLevelsOnRequest) {
  const std::string in = write("in.ply", bumpy_ply(2'000));
  vitrine_json({"build", in, "-o", path("out.pmesh"), "--unit", "m"});
  const json levels = vitrine_json({"info", path("out.pmesh")})["levels"];
  for (const std::string compression : {"none", "meshopt", "draco"}) {
    const json report = vitrine_json({"decode", path("out.pmesh"), "-o", path("out.glb"), "--lod",
                                      "msft", "--compression", compression});
    EXPECT_EQ(report["faces"], levels.back()["faces"]);
    const json glb = json_of_glb(read("out.glb"));
    ASSERT_GE(glb["meshes"].size(), 2u);
    const std::size_t base = glb["meshes"].back()["primitives"][0]["indices"];
    EXPECT_EQ(glb["accessors"][base]["count"], levels[0]["faces"].get<int>() * 3);
    EXPECT_EQ(read_as(read("out.glb"), MeshFormat::kGlb).faces.size(), levels.back()["faces"]);
  }
  const auto refused = [&](const std::string& out, std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"decode", path("out.pmesh"), "-o", path(out), "--lod"});
    expect_fault(vitrine(flags), 2);
  };
  refused("a.ply", {"msft"});
  refused("a.glb", {"all"});
  refused("a.glb", {"msft", "--originals"});
}

TEST_F(VitrineCommand, AnUnknownUnitIsNotedIfTheFormatHasOne) {
  const std::string file = model(200);
  for (const std::string format : {"glb", "stl", "wrl", "3mf", "usdz"}) {
    const ProgramResult noted = vitrine({"decode", file, "-o", path("out." + format)});
    expect_fault(noted, 0);  // exit code 0, and a note in the form of an error message
    EXPECT_THAT(noted.errors, ::testing::HasSubstr("the unit of the model is unknown"));
  }
  vitrine_json({"decode", file, "-o", path("out.ply")});
  const ProgramResult refused = vitrine({"decode", file, "-o", path("out.ply"), "--unit", "mm"});
  expect_fault(refused, 1);
  EXPECT_THAT(refused.errors, ::testing::HasSubstr("cannot be written in mm"));
}

}  // namespace
}  // namespace vitrine::test
