// SPDX-License-Identifier: Apache-2.0
#include "codec/import/reading.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vitrine::testing::bytes_of;
using vitrine::testing::expect_first_dropped;
using vitrine::testing::expect_first_named;
using vitrine::testing::kNotFinite;
using vitrine::testing::read_text;
using vitrine::testing::refusal;

const std::vector<Vec3> kPlyCorners{{0, 0, 0}, {1.5, 0, 0}, {0, -2.25, 0}};

std::string header(std::string_view format, std::string_view rest) {
  return "ply\nformat " + std::string(format) + " 1.0\n" + std::string(rest) + "end_header\n";
}

const std::string kPlain =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\n";

TEST(ReadPly, ReadsAsciiFiles) {
  const auto result = read_text(header("ascii", kPlain) + "0 0 0\n1.5 0 0\n0 -2.25 0\n3 0 1 2\n");
  EXPECT_EQ(result.mesh.positions, kPlyCorners);
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
}

TEST(ReadPly, ReadsBothBinaryByteOrders) {
  for (const bool big : {false, true}) {
    const auto result =
        read_text(header(big ? "binary_big_endian" : "binary_little_endian", kPlain) +
                  bytes_of<float>({0, 0, 0, 1.5, 0, 0, 0, -2.25, 0}, big) + "\x03" +
                  bytes_of<std::int32_t>({0, 1, 2}, big));
    EXPECT_EQ(result.mesh.positions, kPlyCorners);
    EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
  }
}

const std::string kFour =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\n";

TEST(ReadPly, AsciiCoordinatesThatAreNotFinite) {
  for (const auto& [text, value] : kNotFinite) {
    SCOPED_TRACE(text);
    const std::string vertices = header("ascii", kFour) + "0 " + text + " 0\n0 0 0\n1 0 0\n0 1 0\n";
    expect_first_dropped(read_text(vertices + "3 1 2 3\n"));
    expect_first_named(vertices + "3 0 1 2\n");
  }
}

TEST(ReadPly, BinaryCoordinatesThatAreNotFinite) {
  for (const auto& [text, value] : kNotFinite) {
    for (const bool big : {false, true}) {
      SCOPED_TRACE(std::string(text) + (big ? " big endian" : " little endian"));
      const std::string vertices =
          header(big ? "binary_big_endian" : "binary_little_endian", kFour) +
          bytes_of<float>({0, 0, value, 0, 0, 0, 1, 0, 0, 0, 1, 0}, big) + "\x03";
      expect_first_dropped(read_text(vertices + bytes_of<std::int32_t>({1, 2, 3}, big)));
      expect_first_named(vertices + bytes_of<std::int32_t>({0, 1, 2}, big));
    }
  }
}

TEST(ReadPly, WindowsLineEndings) {
  std::string text = header("ascii", kPlain) + "0 0 0\n1.5 0 0\n0 -2.25 0\n3 0 1 2\n";
  for (std::size_t i = 0; (i = text.find('\n', i)) != text.npos; i += 2)
    text.insert(i, "\r");
  EXPECT_EQ(read_text(text).mesh.positions, kPlyCorners);
}

TEST(ReadPly, StepsOverUnknownElementsAndPropertiesAndListsAnywhere) {
  const std::string text =
      header("binary_little_endian",
             "comment made by a scanner\nobj_info num_cols 512\n"
             "element camera 1\nproperty double fov\nproperty list ushort short pixels\n"
             "element vertex 3\nproperty uchar quality\nproperty double x\nproperty double y\n"
             "property list uchar float weights\nproperty double z\n"
             "element face 1\nproperty short material\nproperty list int uint vertex_index\n"
             "property list uchar uchar flags\nelement edge 0\nproperty int vertex1\n") +
      bytes_of<double>({60}) + bytes_of<std::uint16_t>({2, 7, 7}) +  // the element "camera"
      "q" + bytes_of<double>({0, 0}) + std::string(1, 0) + bytes_of<double>({0}) +  //
      "q" + bytes_of<double>({1.5, 0}) + "\x01" + bytes_of<float>({9}) + bytes_of<double>({0}) +
      "q" + bytes_of<double>({0, -2.25}) + std::string(1, 0) + bytes_of<double>({0}) +
      bytes_of<std::int16_t>({4}) + bytes_of<std::uint32_t>({3, 0, 1, 2}) +
      "\x02"
      "ab";
  const auto result = read_text(text);
  EXPECT_EQ(result.mesh.positions, kPlyCorners);
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
}

TEST(ReadPly, ColoursAsBytesAndAsFractions) {
  const std::string position = "property float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const auto bytes = read_text(
      header("ascii", "element vertex 3\n" + position +
                          "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                          "property uchar alpha\n" +
                          face) +
      "0 0 0 1 2 3 255\n1 0 0 255 0 9 255\n0 1 0 4 5 6 0\n3 0 1 2\n");
  EXPECT_THAT(bytes.mesh.attributes.colours,
              ElementsAre(Colour{1, 2, 3}, Colour{255, 0, 9}, Colour{4, 5, 6}));
  const auto integers = read_text(
      header("ascii", "element vertex 3\n" + position +
                          "property int red\nproperty int green\nproperty int blue\n" + face) +
      "0 0 0 1 2 3\n1 0 0 255 0 9\n0 1 0 4 5 6\n3 0 1 2\n");
  EXPECT_EQ(integers.mesh.attributes.colours, bytes.mesh.attributes.colours);
  const auto fractions = read_text(
      header("ascii", "element vertex 3\n" + position +
                          "property float red\nproperty float green\nproperty float blue\n" +
                          face) +
      "0 0 0 1 0 0.5\n1 0 0 2 -1 nan\n0 1 0 0 0 0\n3 0 1 2\n");
  EXPECT_THAT(fractions.mesh.attributes.colours,
              ElementsAre(Colour{255, 0, 128}, Colour{255, 0, 0}, Colour{0, 0, 0}));
}

TEST(ReadPly, FacesBeforeVerticesAndPolygons) {
  const auto result =
      read_text(header("ascii",
                       "element face 1\nproperty list uchar int vertex_indices\n"
                       "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n") +
                "4 0 1 2 3\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n");
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(ReadPly, ReadsTriangleStrips) {
  const auto result =
      read_text(header("ascii",
                       "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                       "element tristrips 1\nproperty list int int vertex_indices\n") +
                "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 2\n");
  EXPECT_THAT(result.mesh.faces,
              ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}, Triangle{0, 1, 2}));
}

TEST(ReadPly, SaysThatATextureWithoutCoordinatesIsNotCarried) {
  const auto result = read_text(header("ascii", "comment TextureFile skin.png\n" + kPlain) +
                                "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_THAT(result.repairs,
              ElementsAre("1 texture map not carried: the file has no texture coordinates; export "
                          "them, too"));
}

TEST(ReadPly, RefusesACountThatTheFileCannotHold) {
  EXPECT_THAT(refusal(header("binary_little_endian",
                             "element vertex 900000000\nproperty float x\nproperty float y\n"
                             "property float z\n") +
                      "abc"),
              HasSubstr("claims 900000000 of element 'vertex', but only 3 bytes"));
  EXPECT_THAT(refusal(header("ascii", "element vertex 18446744073709551615\nproperty float x\n")),
              HasSubstr("claims"));
  EXPECT_THAT(refusal(header("ascii", "element vertex 99999999999999999999999\n")),
              HasSubstr("is not a number"));
}

TEST(ReadPly, RefusesAListThatTheFileCannotHold) {
  EXPECT_THAT(refusal(header("binary_little_endian",
                             "element vertex 1\nproperty char x\nproperty char y\nproperty char z\n"
                             "element face 1\nproperty list uint int vertex_indices\n") +
                      "abc" + bytes_of<std::uint32_t>({0xFFFFFFFF}) + "12345678"),
              HasSubstr("'face' 0 of 1"));
}

TEST(ReadPly, NamesTheLineOfAFaultInAText) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char* line :
         {"ply", "format ascii 1.0", "element vertex 3", "property float x", "property float y",
          "property float z", "element face 1", "property list uchar int vertex_indices",
          "end_header", "0 0 0", "1 0 0", "0 1 0"}) {
      text += line + end;
    }
    EXPECT_THAT(refusal(text + "3 0 1 3" + end),
                HasSubstr("PLY line 13: this face refers to vertex 3 (counted from 0)"));
    EXPECT_THAT(refusal(text + "3 0 x 2" + end),
                HasSubstr("PLY line 13: the file ends or has no number in 'face' 0 of 1"));
  }
}

TEST(ReadPly, NamesTheFaultOfTheHeader) {
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n"),
              HasSubstr("line 4: unknown type 'quad'"));
  EXPECT_THAT(refusal("ply\nformat morse 1.0\n"), HasSubstr("unknown format 'morse'"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\n"), HasSubstr("no end_header"));
  EXPECT_THAT(refusal("ply\nend_header\n"), HasSubstr("no format"));
  EXPECT_THAT(refusal(header("ascii", "property float x\n")),
              HasSubstr("before the first element"));
  EXPECT_THAT(refusal(header("ascii", "element vertex 1\nproperty float x\n") + "0\n"),
              HasSubstr("lack a property x, y or z"));
}

}  // namespace
}  // namespace vitrine
