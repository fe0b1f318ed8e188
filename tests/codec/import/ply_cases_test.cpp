// SPDX-License-Identifier: Apache-2.0
// PLY files in the style of real programs.
#include <bit>

#include "codec/import/cases.h"

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using vitrine::testing::bytes_of;
using vitrine::testing::Case;
using vitrine::testing::expect_case;
using vitrine::testing::kBlueCase;
using vitrine::testing::kFourCases;
using vitrine::testing::kGreenCase;
using vitrine::testing::kOchreCase;
using vitrine::testing::kRedCase;
using vitrine::testing::read_text;
using vitrine::testing::refusal;

// Additional properties of vertices and faces, and their values for each vertex and face.
struct PlyRows {
  std::string vertex_properties = "", index = "int", face_properties = "";
  std::array<std::string, 4> vertices = {}, faces = {};
  std::string comment = "";

  std::string header(const std::string& format) const {
    return "ply\nformat " + format + " 1.0\n" + comment + "element vertex 4\nproperty float x\n" +
           "property float y\nproperty float z\n" + vertex_properties +
           "element face 4\nproperty list uchar " + index + " vertex_indices\n" + face_properties +
           "end_header\n";
  }
  std::string file() const {
    std::string out = header("ascii");
    const char *corners[] = {"0 0 0 ", "1 0 0 ", "0 1 0 ", "0 0 1 "},
               *triangles[] = {"3 0 2 1 ", "3 0 1 3 ", "3 1 2 3 ", "3 2 0 3 "};
    for (std::size_t v = 0; v < 4; ++v)
      out += corners[v] + vertices[v] + "\n";
    for (std::size_t f = 0; f < 4; ++f)
      out += triangles[f] + faces[f] + "\n";
    return out;
  }
};

const std::string kFloatColours = "property float red\nproperty float green\nproperty float blue\n";
const std::string kByteColours = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

std::string with_floats(const std::array<std::string, 4>& vertices) {
  return PlyRows{.vertex_properties = kFloatColours, .vertices = vertices}.file();
}

TEST(PlyCases, ColoursAsFloats) {
  const std::vector<Case> cases{
      {.situation = "0 to 255",
       .file = with_floats({"255 0 0", "0 255 0", "0 0 255", "200 200 0"}),
       .colours = kFourCases},
      {.situation = "0 to 255 with fractions",
       .file = with_floats({"254.9 0 0", "0 255 0.2", "0 0 255", "200.1 199.8 0"}),
       .colours = kFourCases},
      {.situation = "slightly above 1",
       .file = with_floats({"1.0039 0 0", "0 1 0", "0 0 1", "0.7843 0.7843 0"}),
       .colours = kFourCases,
       .said = "1 colour value above 1 clipped to 1"}};
  for (const Case& expected : cases)
    expect_case(expected);
}

std::string with_packed(const std::string& property, const std::array<std::string, 4>& vertices) {
  return PlyRows{.vertex_properties = "property " + property + "\n", .vertices = vertices}.file();
}

// Returns a binary PLY with one face. Each of its three vertices has the packed colour `colour`.
// `property` declares the colour's type and name.
std::string binary_packed(const std::string& property, const std::string& colour) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
         "property float y\nproperty float z\nproperty " +
         property + "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         bytes_of<float>({0, 0, 0}) + colour + bytes_of<float>({1, 0, 0}) + colour +
         bytes_of<float>({0, 1, 0}) + colour + "\x03" + bytes_of<std::int32_t>({0, 1, 2});
}

TEST(PlyCases, ColoursPackedInOneNumber) {
  const std::vector<Colour> ochre(3, kOchreCase);
  const std::string bits = bytes_of<std::uint32_t>({0xFFC8C800});
  const std::vector<Case> cases{
      {.situation = "uint rgba",
       .file = with_packed("uint rgba", {"4294901760", "4278255360", "4278190335", "4291348480"}),
       .colours = kFourCases},
      {.situation = "negative int rgba",
       .file = with_packed("int rgba", {"-65536", "-16711936", "-16776961", "-3618816"}),
       .colours = kFourCases},
      {.situation = "float rgb, with the bits of 0x0000FF and 0x00FF00",
       .file = with_packed("float rgb", {"3.57331108403e-43", "9.14767637511e-41",
                                         "3.57331108403e-43", "3.57331108403e-43"}),
       .colours = {kBlueCase, kGreenCase, kBlueCase, kBlueCase}},
      {.situation = "binary uint",
       .file = binary_packed("uint rgba", bits),
       .faces = 1,
       .colours = ochre},
      {.situation = "binary float whose bits are no number",
       .file = binary_packed("float rgb", bits),
       .faces = 1,
       .colours = ochre}};
  for (const Case& expected : cases)
    expect_case(expected);
}

TEST(PlyCases, ColoursOfFaces) {
  const std::array<std::string, 4> two{"255 0 0", "255 0 0", "255 0 0", "0 0 255"};
  const std::vector<Case> cases{
      {.situation = "bytes",
       .file = PlyRows{.face_properties = kByteColours, .faces = two}.file(),
       .colours = {{213, 0, 156}, kRedCase, {213, 0, 156}, {213, 0, 156}},
       .said = "colours of 4 faces averaged at the vertices"},
      {.situation = "floats, the same for all",
       .file =
           PlyRows{.face_properties = kFloatColours, .faces = {"1 0 0", "1 0 0", "1 0 0", "1 0 0"}}
               .file(),
       .colours = std::vector(4, kRedCase)},
      {.situation = "vertices have colours",
       .file = PlyRows{.vertex_properties = kByteColours,
                       .face_properties = kByteColours,
                       .vertices = {"255 0 0", "0 255 0", "0 0 255", "200 200 0"},
                       .faces = two}
                   .file(),
       .colours = kFourCases,
       .said = "colours of 4 faces not carried: the vertices have colours of their own"}};
  for (const Case& expected : cases)
    expect_case(expected);
}

TEST(PlyCases, IntegersOf64Bits) {
  expect_case({.situation = "int64", .file = PlyRows{.index = "int64"}.file()});
  expect_case({.situation = "uint64", .file = PlyRows{.index = "uint64"}.file()});
  const std::string head =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty int64 x\nproperty uint64 y\n"
      "property float z\nelement face 1\nproperty list int64 uint64 vertex_indices\nend_header\n";
  const auto row = [](std::int64_t x, std::int64_t y) {
    return bytes_of<std::int64_t>({x}, true) + bytes_of<std::int64_t>({y}, true) +
           bytes_of<float>({0});
  };
  const std::string rows = row(0, 0) + row(-7, 0) + row(0, 9) + bytes_of<std::int64_t>({3}, true);
  const auto read = read_text(head + rows + bytes_of<std::int64_t>({0, 1, 2}, true));
  EXPECT_EQ(read.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {-7, 0, 0}, {0, 9, 0}}));
  EXPECT_THAT(refusal(head + rows + bytes_of<std::int64_t>({0, 1, 1LL << 40}, true)),
              HasSubstr("a vertex below 0 or beyond 32 bits"));
}

TEST(PlyCases, UnitsInWorldAreNoInches) {
  const std::string comment = "comment units in world coordinate system\n";
  EXPECT_EQ(read_text(PlyRows{.comment = comment}.file()).unit, "");
}

TEST(PlyCases, DecimalCommasAreNamed) {
  std::string file = PlyRows{}.file();
  file.replace(file.find("0 1 0"), 5, "0 1,5 0");
  EXPECT_THAT(refusal(file), HasSubstr("numbers have decimal commas; write them with points"));
}

}  // namespace
}  // namespace vitrine
