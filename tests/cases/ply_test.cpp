// SPDX-License-Identifier: Apache-2.0
// PLY files in the style of real programs.
#include <bit>

#include "cases/kind.h"

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

std::vector<Case> colours_as_floats() {
  return {{.situation = "0 to 255",
           .file = with_floats({"255 0 0", "0 255 0", "0 0 255", "200 200 0"}),
           .colours = kFourCases},
          {.situation = "0 to 255 with fractions",
           .file = with_floats({"254.9 0 0", "0 255 0.2", "0 0 255", "200.1 199.8 0"}),
           .colours = kFourCases},
          {.situation = "slightly above 1",
           .file = with_floats({"1.0039 0 0", "0 1 0", "0 0 1", "0.7843 0.7843 0"}),
           .colours = kFourCases,
           .said = "1 colour value above 1 clipped to 1"}};
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

TEST(PlyCases, LostOpacityIsCounted) {
  const std::string alpha = "property uchar alpha\n";
  const std::vector<Case> cases{
      {.situation = "bytes",
       .file = PlyRows{.vertex_properties = kByteColours + alpha,
                       .vertices = {"255 0 0 255", "0 255 0 254", "0 0 255 0", "200 200 0 255"}}
                   .file(),
       .colours = kFourCases,
       .said = "opacity of 2 colours not carried: vertex colours are opaque; "},
      {.situation = "opaque bytes",
       .file = PlyRows{.vertex_properties = kByteColours + alpha,
                       .vertices = {"255 0 0 255", "0 255 0 255", "0 0 255 255", "200 200 0 255"}}
                   .file(),
       .colours = kFourCases},
      {.situation = "floats of faces",
       .file = PlyRows{.face_properties = kFloatColours + "property float alpha\n",
                       .faces = {"1 0 0 1", "1 0 0 1", "1 0 0 0.5", "1 0 0 1"}}
                   .file(),
       .colours = std::vector(4, kRedCase),
       .said = "opacity of 1 colour not carried"},
      {.situation = "packed",
       .file = with_packed("uint rgba", {"4294901760", "4278255360", "255", "4291348480"}),
       .colours = kFourCases,
       .said = "opacity of 1 colour not carried"}};
  for (const Case& expected : cases)
    expect_case(expected);
}

// Returns a text file with further elements: their declarations and their values.
std::string with_elements(const std::string& declared, const std::string& values) {
  const std::string file = PlyRows{}.file();
  const std::size_t end = file.find("end_header");
  return file.substr(0, end) + declared + file.substr(end) + values;
}

std::vector<Case> other_elements() {
  const std::string materials = "element material 3\nproperty uchar red\n";
  return {{.situation = "edges",
           .file = with_elements("element edge 2\nproperty int vertex1\nproperty int vertex2\n",
                                 "0 1\n1 2\n"),
           .said = "2 edges not carried; convert what you need to faces"},
          {.situation = "materials",
           .file = with_elements(materials, "1\n2\n3\n"),
           .said = "3 elements of other kinds ('material') not carried; export what you need as "
                   "faces and vertex colours"},
          {.situation = "two kinds",
           .file = with_elements(materials + "element a 1\nproperty int x\n", "1\n2\n3\n4\n"),
           .said = "4 elements of other kinds ('material', 'a') not carried"},
          {.situation = "a scanner's camera and grid, and an empty element",
           .file = with_elements("element camera 1\nproperty float view_px\n"
                                 "element range_grid 1\nproperty list uchar int vertex_indices\n"
                                 "element material 0\nproperty int x\n",
                                 "0\n1 0\n")}};
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

std::vector<Case> face_colours() {
  const std::array<std::string, 4> two{"255 0 0", "255 0 0", "255 0 0", "0 0 255"};
  return {{.situation = "bytes",
           .file = PlyRows{.face_properties = kByteColours, .faces = two}.file(),
           .colours = {{213, 0, 156}, kRedCase, {213, 0, 156}, {213, 0, 156}},
           .said = "colours of 4 faces averaged at the vertices"},
          {.situation = "floats, the same for all",
           .file = PlyRows{.face_properties = kFloatColours,
                           .faces = {"1 0 0", "1 0 0", "1 0 0", "1 0 0"}}
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
}

TEST(PlyCases, IntegersOf64Bits) {
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

// Returns a binary file with indices of the type `type`, int64 or uint64.
std::string with_wide_indices(const std::string& type, bool big_endian) {
  const std::string format = big_endian ? "binary_big_endian" : "binary_little_endian";
  std::string file = PlyRows{.index = type}.header(format);
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F})
    file += bytes_of<float>({x}, big_endian);
  for (const Triangle& t : testing::tetrahedron().faces) {
    file += '\x03';
    for (const std::uint32_t corner : t)
      file += bytes_of<std::int64_t>({corner}, big_endian);
  }
  return file;
}

std::vector<Case> integers_of_64_bits() {
  const std::vector<Triangle> faces = testing::tetrahedron().faces;
  return {
      {.situation = "int64", .file = PlyRows{.index = "int64"}.file(), .triangles = faces},
      {.situation = "uint64", .file = PlyRows{.index = "uint64"}.file(), .triangles = faces},
      {.situation = "long", .file = PlyRows{.index = "long"}.file(), .triangles = faces},
      {.situation = "ulong", .file = PlyRows{.index = "ulong"}.file(), .triangles = faces},
      {.situation = "binary long",
       .file = with_wide_indices("long", false),
       .refused = "PLY header, line 8: the type 'long' has no fixed size; export the file as text"},
      {.situation = "binary int64", .file = with_wide_indices("int64", false), .triangles = faces},
      {.situation = "binary uint64, big endian",
       .file = with_wide_indices("uint64", true),
       .triangles = faces}};
}

std::vector<Case> comments_without_a_unit() {
  std::vector<Case> cases;
  for (const std::string words :
       {"units in world coordinate system", "Units are in world space", "unit: in local space"})
    cases.push_back({.situation = words,
                     .file = PlyRows{.comment = "comment " + words + "\n"}.file(),
                     .unit = ""});
  return cases;
}

// Returns the declarations of colours whose components have the type `type`.
std::string colours_as(const std::string& type) {
  return "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
}

std::vector<Case> colours_of_wide_integers() {
  const auto file = [&](const std::string& type, const std::array<std::string, 4>& vertices) {
    return PlyRows{.vertex_properties = colours_as(type), .vertices = vertices}.file();
  };
  const auto with_faces = [&](const std::string& type, const std::string& colour) {
    return PlyRows{.face_properties = colours_as(type), .faces = {colour, colour, colour, colour}}
        .file();
  };
  const std::vector<Colour> ochre(4, kOchreCase);
  const std::array<std::string, 4> up_to_255{"255 0 0", "0 255 0", "0 0 255", "200 200 0"},
      up_to_65535{"65535 0 0", "0 65535 0", "0 0 65535", "51400 51400 0"};
  std::vector<Case> cases{
      {.situation = "some up to 255",
       .file = file("ushort", {"65535 0 0", "0 65535 0", "0 0 65535", "255 0 0"}),
       .colours = {kRedCase, kGreenCase, kBlueCase, {1, 0, 0}}},
      {.situation = "beyond 16 bits",
       .file = file("uint", {"65536 0 0", "0 65535 0", "0 0 65535", "51400 51400 0"}),
       .colours = kFourCases,
       .said = "1 colour value above 1 clipped to 1"},
      {.situation = "one slightly above 255",
       .file = file("int", {"256 0 0", "0 255 0", "0 0 255", "200 200 0"}),
       .colours = kFourCases,
       .said = "1 colour value above 255 clipped to 255; export colours from 0 to 255"},
      {.situation = "twice 255",
       .file = file("ushort", {"510 0 0", "0 510 0", "0 0 255", "200 200 0"}),
       .colours = kFourCases,
       .said = "2 colour values above 255 clipped to 255"},
      {.situation = "faces slightly above 255",
       .file = with_faces("ushort", "300 0 0"),
       .colours = std::vector(4, kRedCase),
       .said = "4 colour values above 255 clipped to 255"},
      {.situation = "dark colours up to 65535",
       .file = file("ushort", {"511 0 0", "0 257 0", "0 0 255", "0 0 0"}),
       .colours = {{2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}},
      {.situation = "faces up to 255 with full opacity",
       .file =
           PlyRows{.face_properties = colours_as("ushort") + "property ushort alpha\n",
                   .faces = {"200 200 0 255", "200 200 0 255", "200 200 0 255", "200 200 0 255"}}
               .file(),
       .colours = std::vector(4, kOchreCase)}};
  for (const std::string type : {"ushort", "int", "uint", "int64"}) {
    const auto add = [&](const std::string& situation, const std::string& text,
                         const std::vector<Colour>& colours) {
      cases.push_back({.situation = type + situation, .file = text, .colours = colours});
    };
    add(" up to 255", file(type, up_to_255), kFourCases);
    add(" up to 65535", file(type, up_to_65535), kFourCases);
    add(" of faces up to 255", with_faces(type, "200 200 0"), ochre);
    add(" of faces up to 65535", with_faces(type, "51400 51400 0"), ochre);
  }
  return cases;
}

std::vector<Case> names_in_capitals() {
  std::vector<Case> cases;
  for (const std::string names :
       {"R G B", "Red Green Blue", "DIFFUSE_RED DIFFUSE_GREEN DIFFUSE_BLUE"}) {
    const std::size_t first = names.find(' '), last = names.rfind(' ');
    const std::string type = "property uchar ";
    const PlyRows rows{.vertex_properties = type + names.substr(0, first) + "\n" + type +
                                            names.substr(first + 1, last - first - 1) + "\n" +
                                            type + names.substr(last + 1) + "\n",
                       .vertices = {"255 0 0", "0 255 0", "0 0 255", "200 200 0"}};
    cases.push_back({.situation = names, .file = rows.file(), .colours = kFourCases});
  }
  return cases;
}

TEST(PlyCases, TheFirstLineMayHaveCapitalsAndBlanks) {
  const std::string rest = PlyRows{.comment = "comment unit mm\n"}.file().substr(3);
  for (const std::string first : {"PLY", "Ply", "ply ", "ply\t ", "ply \r"})
    expect_case({.situation = first, .file = first + rest, .unit = "mm"});
  EXPECT_THAT(refusal("plywood" + rest), HasSubstr("not a mesh file"));
}

std::vector<Case> values_at_vertices() {
  const auto rows = [](const std::string& properties, const std::string& values) {
    return PlyRows{.vertex_properties = properties, .vertices = {values, values, values, values}}
        .file();
  };
  const std::string lost = " of values at the vertices not carried: ";
  return {{.situation = "quality of MeshLab",
           .file = rows("property float quality\n", "1"),
           .said = "1 kind" + lost + "'quality'; to show them"},
          {.situation = "of a scanner",
           .file = rows("property float confidence\nproperty uchar intensity\n", "0.5 7"),
           .said = "2 kinds" + lost + "'confidence', 'intensity'"},
          {.situation = "a list",
           .file = rows("property list uchar int neighbours\n", "2 1 2"),
           .said = "1 kind" + lost + "'neighbours'"}};
}

TEST(PlyCases, NormalsAreNoLoss) {
  expect_case({.situation = "normals",
               .file = PlyRows{.vertex_properties =
                                   "property float nx\nproperty float ny\nproperty float nz\n",
                               .vertices = {"0 0 1", "0 0 1", "0 0 1", "0 0 1"}}
                           .file()});
}

TEST(PlyCases, DecimalCommasAreNamed) {
  std::string file = PlyRows{}.file();
  file.replace(file.find("0 1 0"), 5, "0 1,5 0");
  EXPECT_THAT(refusal(file), HasSubstr("numbers have decimal commas; write them with points"));
}

}  // namespace

std::vector<testing::FileKind> testing::ply_kinds() {
  return {{"float255.ply", colours_as_floats()},
          {"face_colour.ply", face_colours()},
          {"int64.ply", integers_of_64_bits()},
          {"units_in_world.ply", comments_without_a_unit()},
          {"ushort255.ply", colours_of_wide_integers()},
          {"capitals.ply", names_in_capitals()},
          {"quality.ply", values_at_vertices()},
          {"elements.ply", other_elements()}};
}

}  // namespace vitrine
