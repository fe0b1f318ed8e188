// SPDX-License-Identifier: Apache-2.0
// OBJ files in the style of real programs.
#include "codec/import/cases.h"
#include "codec/picture/pictures.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vitrine::testing::Case;
using vitrine::testing::expect_case;
using vitrine::testing::kBlue;
using vitrine::testing::kFourCases;
using vitrine::testing::kGreenCase;
using vitrine::testing::kRed;
using vitrine::testing::kRedCase;
using vitrine::testing::kWhiteCase;
using vitrine::testing::png_of;
using vitrine::testing::read_case;
using vitrine::testing::read_text;
using vitrine::testing::red_and_blue;
using vitrine::testing::refusal;

const std::string kObjCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string kObjFaces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

TEST(ObjCases, AnEmptyLastFieldKeepsTheNextCorner) {
  const std::string pentagon =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 1.5 0\nv 0 1 0\nv 0.5 0.5 1\n"
      "f 5// 4// 3// 2// 1//\nf 1 2 6\nf 2 3 6\nf 3 4 6\nf 4 5 6\nf 5 1 6\n";
  EXPECT_EQ(read_text(pentagon).mesh.faces.size(), 8u);
  for (const std::string end : {"//", "/", "//\t"}) {
    SCOPED_TRACE(end);
    const std::string corners = "f 1" + end + " 3" + end + " 2" + end + "\n";
    EXPECT_THAT(read_text(kObjCorners + corners).mesh.faces, ElementsAre(Triangle{0, 2, 1}));
  }
  EXPECT_THAT(read_text(kObjCorners + "f 1//\\\n 3// 2//# end\n").mesh.faces,
              ElementsAre(Triangle{0, 2, 1}));
}

// Returns a tetrahedron as OBJ. numbers[i] follows the coordinates of vertex i.
std::string painted(const std::array<std::string, 4>& numbers) {
  return "v 0 0 0 " + numbers[0] + "\nv 1 0 0 " + numbers[1] + "\nv 0 1 0 " + numbers[2] +
         "\nv 0 0 1 " + numbers[3] + "\n" + kObjFaces;
}

TEST(ObjCases, Colours) {
  const std::vector<Case> cases{
      {.situation = "components of 256 / 255",
       .file = painted({"1.003922 0 0", "0 1.003922 0", "0 0 1.003922", "0.784314 0.784314 0"}),
       .colours = kFourCases,
       .said = "3 colour values above 1 clipped to 1"},
      {.situation = "one component slightly above 1",
       .file = painted({"1.000001 0 0", "0 1 0", "0 0 1", "0.784314 0.784314 0"}),
       .colours = kFourCases,
       .said = "1 colour value above 1 clipped to 1"},
      {.situation = "one light far above 1 among fractions",
       .file = painted({"4 0 0", "0 1 0", "0 0 1", "0.784314 0.784314 0"}),
       .colours = kFourCases,
       .said = "1 colour value above 1 clipped to 1"},
      {.situation = "r g b and opacity",
       .file = painted({"1 0 0 1", "0 1 0 1", "0 0 1 1", "0.784314 0.784314 0 1"}),
       .colours = kFourCases,
       .said = "opacity of 4 vertex colours not carried"},
      {.situation = "w r g b",
       .file = painted({"1 1 0 0", "1 0 1 0", "1 0 0 1", "1 0.784314 0.784314 0"}),
       .colours = kFourCases,
       .said = "4 lines of four numbers after x y z read as w r g b"},
      {.situation = "a vertex without a colour among colours from 0 to 255",
       .file = painted({"255 0 0", "0 255 0", "", "0 0 9"}),
       .colours = {kRedCase, kGreenCase, kWhiteCase, {0, 0, 9}}}};
  for (const Case& expected : cases)
    expect_case(expected);
}

TEST(ObjCases, PaintOfZBrush) {
  const std::vector<Case> cases{
      {.situation = "all in one line",
       .file = kObjCorners + "#MRGB ffff0000ff00ff00ff0000ffffc8c800\n" + kObjFaces,
       .colours = kFourCases},
      {.situation = "two lines, with a mask",
       .file = kObjCorners + "#MRGB 00ff0000ff00ff00\r\n#MRGB 800000ffffc8c800\r\n" + kObjFaces,
       .colours = kFourCases},
      {.situation = "fewer colours than vertices",
       .file = kObjCorners + kObjFaces + "#MRGB ffff0000ff00ff00\n",
       .colours = {kRedCase, kGreenCase, kWhiteCase, kWhiteCase}}};
  for (const Case& expected : cases)
    expect_case(expected);
}

TEST(ObjCases, DecimalCommasAreNamed) {
  EXPECT_EQ(refusal("v 0,5 0,0 1,0\n"),
            "OBJ line 1: numbers have decimal commas; write them with points");
  EXPECT_EQ(refusal("v 0 0 0\nv 0 -1,5e3 1,0\n"),
            "OBJ line 2: numbers have decimal commas; write them with points");
}

// Returns an OBJ whose vertices all have the texture coordinates (0.25, 0.5).
std::string dressed(const std::string& libraries, const std::string& material = "m") {
  return libraries + "\n" + kObjCorners + "vt 0.25 0.5\nusemtl " + material +
         "\nf 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 2/1 3/1 4/1\nf 3/1 1/1 4/1\n";
}

const std::vector<Colour> kAllRed(4, kRed), kAllBlue(4, kBlue);

// Expects that a material with this statement gives the vertices `colours`, from the picture "t
// a.png".
void expect_statement(const std::string& statement, const std::vector<Colour>& colours) {
  expect_case(
      {.situation = statement,
       .file = dressed("mtllib m.mtl"),
       .colours = colours,
       .said = "1 texture map baked",
       .beside = {{"m.mtl", "newmtl m\n" + statement + "\n"}, {"t a.png", red_and_blue()}}});
}

TEST(ObjCases, StatementsOfMapsInAnyCaseWithOptions) {
  for (const std::string name :
       {"t a.png", "T A.PNG", "maps/t a.png", "..\\maps\\t a.png", "\"t a.png\""}) {
    expect_statement("map_kd " + name, kAllRed);
    expect_statement("MAP_KD -clamp on " + name, kAllRed);
    expect_statement("map_Kd -s 1 1 1 -bm 0.2 " + name, kAllRed);
    expect_statement("map_Kd -o 0.5 0 0 " + name, kAllBlue);
  }
  expect_statement("map_Kd -s 3 1 t a.png", kAllBlue);
  expect_statement("map_Kd -o 1 0 -clamp on t a.png", kAllBlue);
}

TEST(ObjCases, OptionsOfMapsPlaceTheCarriedPicture) {
  const auto read =
      read_case({.file = dressed("mtllib m.mtl"),
                 .beside = {{"m.mtl", "newmtl m\nmap_Kd -s 2 4 -o 0.5 0.25 -clamp on t.png\n"},
                            {"t.png", red_and_blue()}}});
  const auto& map = read.texturing.materials.at(0).base_colour_map;
  ASSERT_TRUE(map);
  EXPECT_THAT(map->transform.scale, ElementsAre(2, 4));
  EXPECT_THAT(map->transform.offset, ElementsAre(0.5, -3.25));
  EXPECT_EQ(map->wrap_u, Wrap::kClamp);
}

TEST(ObjCases, Libraries) {
  const std::string red = "newmtl m\nKd 1 0 0\n", other = "newmtl n\nKd 0 0 1\n";
  const std::string kBaked = "material colours baked";
  const std::vector<Case> cases{
      {.situation = "two names",
       .file = dressed("mtllib a.mtl b.mtl"),
       .colours = kAllRed,
       .said = kBaked,
       .beside = {{"a.mtl", other}, {"b.mtl", red}}},
      {.situation = "two names with blanks",
       .file = dressed("mtllib my a.mtl  my b.mtl "),
       .colours = kAllRed,
       .said = kBaked,
       .beside = {{"my a.mtl", other}, {"my b.mtl", red}}},
      {.situation = "one of two is missing",
       .file = dressed("mtllib my a.mtl b.mtl"),
       .colours = kAllRed,
       .said = "material library 'my a.mtl' not carried: it is not beside the mesh file",
       .beside = {{"b.mtl", red}}},
      {.situation = "the library lacks the material",
       .file = dressed("mtllib a.mtl"),
       .said = "1 material not in the material library, such as 'm'",
       .beside = {{"a.mtl", other}}},
      {.situation = "the library lacks the material of some faces",
       .file = dressed("mtllib a.mtl") + "usemtl n\nf 1 3 2\n",
       .faces = 5,
       .colours = {kBlue, kBlue, kBlue, kWhiteCase},
       .said = "1 material not in the material library, such as 'm'",
       .beside = {{"a.mtl", other}}}};
  for (const Case& expected : cases)
    expect_case(expected);
}

TEST(ObjCases, NamesInWindows1252FindFilesNamedInUtf8) {
  for (const std::string name : {"B\xFCste \x80.png", "maps\\B\xFCste \x80.png"}) {
    expect_case({.situation = name,
                 .file = dressed("mtllib B\xFCste.mtl"),
                 .colours = kAllRed,
                 .said = "1 texture map baked",
                 .beside = {{"b\xC3\xBCste.mtl", "newmtl m\nmap_Kd " + name + "\n"},
                            {"b\xC3\xBCste \xE2\x82\xAC.png", red_and_blue()}}});
  }
}

TEST(ObjCases, PicturesOfOtherFormatsAreNamed) {
  const std::string tiff("II*\0", 4), bmp = "BM" + std::string(60, '\0');
  for (const auto& [picture, type] : {std::pair(tiff, "image/tiff"), std::pair(bmp, "image/bmp")}) {
    const auto read =
        read_case({.file = dressed("mtllib m.mtl"),
                   .beside = {{"m.mtl", "newmtl m\nmap_Kd t.x\n"}, {"t.x", picture}}});
    EXPECT_THAT(read.repairs,
                ::testing::Contains(HasSubstr("'t.x' not carried: it is " + std::string(type) +
                                              "; convert it to PNG, JPEG or WebP")));
  }
}

TEST(ObjCases, ABlackMaterialShowsItsEmission) {
  expect_statement("Kd 0 0 0\nmap_Ke t a.png", kAllRed);
  expect_statement("kd 0 0 0\nKe 1 1 1\nmap_Ke -o 0.5 t a.png", kAllBlue);
  expect_case({.situation = "without a picture",
               .file = dressed("mtllib m.mtl"),
               .colours = kAllRed,
               .said = "material colours baked",
               .beside = {{"m.mtl", "newmtl m\nKd 0 0 0\nKe 1 0 0\n"}}});
}

}  // namespace
}  // namespace vitrine
