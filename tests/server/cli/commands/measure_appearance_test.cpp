// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <array>

#include "codec/picture/write_picture.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST_F(VitrineCommand, MeasureComparesAppearance) {
  const std::string file = model();
  vitrine_json({"decode", file, "-o", path("coarse.ply"), "--level", "0"});
  const json coarse =
      vitrine_json({"measure", path("coarse.ply"), path("model.ply"), "--appearance"});
  EXPECT_GT(coarse["psnr"].get<double>(), 10);
  EXPECT_LT(coarse["ssim"].get<double>(), 0.99);
  EXPECT_THAT(vitrine({"measure", file, file, "--appearance"}).output,
              HasSubstr("PSNR: the pictures are equal\nSSIM: 1.0000"));
}

// A white picture with a spot in the middle.
std::string spotted_png(std::uint8_t spot) {
  Picture picture{3, 3, std::vector<std::uint8_t>(36, 255)};
  std::fill_n(picture.pixels.begin() + 16, 3, spot);
  const auto bytes = write_png(picture);
  return {bytes->begin(), bytes->end()};
}

TEST_F(VitrineCommand, MeasureComparesTexturesBetweenTheVertices) {
  const auto square = [&](const std::string& name, std::uint8_t spot) {
    write(name + ".png", spotted_png(spot));
    write(name + ".mtl", "newmtl m\nmap_Kd " + name + ".png\n");
    return write(name + ".obj", "mtllib " + name +
                                    ".mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  };
  const std::string white = square("white", 255), dark = square("dark", 0);
  EXPECT_TRUE(vitrine_json({"measure", white, white, "--appearance"})["psnr"].is_null());
  const json spotted = vitrine_json({"measure", dark, white, "--appearance"});
  EXPECT_LT(spotted["psnr"].get<double>(), 30);
  EXPECT_LT(spotted["ssim"].get<double>(), 0.99);
}

TEST_F(VitrineCommand, AWhiteMaterialLooksLikeNoMaterial) {
  constexpr std::array<float, 9> kPositions{0, 0, 0, 1, 0, 0, 0, 1, 0};
  write("p.bin", {reinterpret_cast<const char*>(kPositions.data()), sizeof kPositions});
  json gltf = json::parse(R"({"asset": {"version": "2.0"},
    "buffers": [{"uri": "p.bin", "byteLength": 36}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})");
  const std::string none = write("none.gltf", gltf.dump());
  gltf["materials"] = json::parse(R"([{"name": "metallic by default"}])");
  gltf["meshes"][0]["primitives"][0]["material"] = 0;
  const std::string white = write("white.gltf", gltf.dump());
  EXPECT_TRUE(vitrine_json({"measure", white, none, "--appearance"})["psnr"].is_null());
}

constexpr const char* kTexturedTriangle =
    "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
    "f 1/1 2/2 3/3\n";

TEST_F(VitrineCommand, MeasureNotesPicturesThatItDoesNotCompare) {
  const std::string textured = write("textured.obj", kTexturedTriangle);
  const std::string plain = write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(vitrine({"measure", plain, textured, "--appearance"}).errors,
              HasSubstr("note: B: 1 material library 'm.mtl' not carried: it is not beside"));
  write("m.mtl", "newmtl m\nmap_Kd lost.png\n");
  EXPECT_EQ(
      vitrine({"measure", textured, textured, "--appearance"}).errors,
      "vitrine: note: "
      "A: 1 texture map 'lost.png' not carried: it is not beside the mesh file; copy it there, or "
      "pack both in one zip; "
      "B: 1 texture map 'lost.png' not carried: it is not beside the mesh file; copy it there, or "
      "pack both in one zip\n");
  EXPECT_EQ(vitrine({"measure", textured, textured}).errors, "");
}

TEST_F(VitrineCommand, MeasureDoesNotNoteVertexColoursThatThePicturesReplace) {
  write("m.mtl", "newmtl m\nmap_Kd white.png\n");
  write("white.png", spotted_png(255));
  std::string text = kTexturedTriangle;
  for (const std::string_view vertex : {"v 0 0 0", "v 1 0 0", "v 0 1 0"})
    text.insert(text.find(vertex) + vertex.size(), " 1 0 0");
  const std::string textured = write("textured.obj", text);
  EXPECT_EQ(vitrine({"measure", textured, textured, "--appearance"}).errors, "");
}

}  // namespace
}  // namespace vitrine::test
