// SPDX-License-Identifier: Apache-2.0
// OBJ files in the style of real programs.
#include "cases/kind.h"
#include "codec/picture/bitmaps.h"
#include "codec/picture/decode_picture.h"
#include "codec/picture/pictures.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vitrine::testing::bmp_of;
using vitrine::testing::Case;
using vitrine::testing::expect_case;
using vitrine::testing::kBlue;
using vitrine::testing::kBlueCase;
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
using vitrine::testing::tga_of;
using vitrine::testing::tiff_of;

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

TEST(ObjCases, ElementsWithoutFacesAreCounted) {
  expect_case(
      {.situation = "points, lines, a curve and a surface",
       .file = kObjCorners + kObjFaces +
               "l 1 2 3\nl 2 4\np 1\ncstype bezier\ndeg 1 1\ncurv 0 1 1 2\nparm u 0 1\nend\n"
               "surf 0 1 0 1 1 2 3 4\nend\n",
       .said = "5 elements without faces (1 curv statement, 2 l statements, 1 p statement, 1 "
               "surf statement) not carried; convert what you need to polygons"});
}

std::vector<Case> other_statements() {
  std::string many = kObjCorners + kObjFaces;
  for (const char letter : std::string("abcdehijkm"))
    many += std::string("x") + letter + " 1\n";
  return {
      {.situation = "keywords in capitals",
       .file = "MTLLIB m.mtl\nV 0 0 0\nV 1 0 0\nV 0 1 0\nV 0 0 1\nVN 0 0 1\nUSEMTL m\n"
               "F 1 3 2\nF 1 2 4\nF 2 3 4\nF 3 1 4\n",
       .colours = std::vector(4, kRedCase),
       .said = "colours of 1 material baked",
       .beside = {{"m.mtl", "newmtl m\nKd 1 0 0\n"}}},
      {.situation = "fo, the former keyword of a face",
       .file = kObjCorners + "fo 1 3 2\nfo 1 2 4\nfo 2 3 4\nfo 3 1 4\n"},
      {.situation = "colours of vertices on their own lines",
       .file = kObjCorners + "vc 1 0 0\nvc 1 0 0\nvc 1 0 0\nvc 1 0 0\n" + kObjFaces,
       .said = "4 unknown statements not carried ('vc'); if they hold faces or colours, export "
               "the model as PLY or GLB"},
      {.situation = "statements of groups, smoothing and detail",
       .file = "G a\n" + kObjCorners + "o b\ng c\ns off\nmg 1 0.5\nlod 3\nbevel on\n" + kObjFaces},
      {.situation = "more unknown statements than are named",
       .file = many,
       .said = "10 unknown statements not carried ('xa', 'xb', 'xc', 'xd'); if they hold"}};
}

std::vector<Case> colours_above_1() {
  return {{.situation = "components of 256 / 255",
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
           .said = "1 colour value above 1 clipped to 1"}};
}

std::vector<Case> colours_of_four_numbers() {
  return {{.situation = "r g b and opacity",
           .file = painted({"1 0 0 1", "0 1 0 1", "0 0 1 1", "0.784314 0.784314 0 1"}),
           .colours = kFourCases,
           .said = "opacity of 4 vertex colours not carried"},
          {.situation = "numbers that could be either",
           .file = painted({"1 0 0 0.5", "0 1 0 1", "0 0 1 1", "0.784314 0.784314 0 1"}),
           .colours = {{0, 0, 128}, {255, 0, 255}, {0, 255, 255}, {200, 0, 255}},
           .said = "read as w r g b; write x y z r g b if the numbers are r g b and opacity"},
          {.situation = "w r g b",
           .file = painted({"1 1 0 0", "1 0 1 0", "1 0 0 1", "1 0.784314 0.784314 0"}),
           .colours = kFourCases,
           .said = "4 lines of four numbers after x y z read as w r g b"}};
}

TEST(ObjCases, AVertexWithoutAColourAmongColoursFrom0To255) {
  expect_case({.situation = "",
               .file = painted({"255 0 0", "0 255 0", "", "0 0 9"}),
               .colours = {kRedCase, kGreenCase, kWhiteCase, {0, 0, 9}},
               .said = "1 colour missing or not a number, white instead"});
}

std::vector<Case> paint_of_zbrush() {
  return {{.situation = "all in one line",
           .file = kObjCorners + "#MRGB ffff0000ff00ff00ff0000ffffc8c800\n" + kObjFaces,
           .colours = kFourCases},
          {.situation = "two lines, with a mask",
           .file = kObjCorners + "#MRGB 00ff0000ff00ff00\r\n#MRGB 800000ffffc8c800\r\n" + kObjFaces,
           .colours = kFourCases},
          {.situation = "fewer colours than vertices",
           .file = kObjCorners + kObjFaces + "#MRGB ffff0000ff00ff00\n",
           .colours = {kRedCase, kGreenCase, kWhiteCase, kWhiteCase},
           .said = "2 colours missing or not a number, white instead"}};
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

// Expects that a material with the given statement, which refers to the picture "t a.png", gives
// the vertices the colours `colours`.
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

TEST(ObjCases, ReadMaterialLibrariesOfAnyName) {
  const std::string red = "newmtl m\nKd 1 0 0\n", other = "newmtl n\nKd 0 0 1\n";
  const std::string kBaked = "colours of 1 material baked";
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
       .beside = {{"b.mtl", red}}}};
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
  const auto read = read_case({.file = dressed("mtllib m.mtl"),
                               .beside = {{"m.mtl", "newmtl m\nmap_Kd t.x\n"}, {"t.x", "GIF89a"}}});
  EXPECT_THAT(read.repairs, ::testing::Contains(HasSubstr(
                                "'t.x' not carried: it is image/gif; convert it to PNG, JPEG or "
                                "WebP")));
}

// The material has no colour except its map, so the colours show that the map was read.
TEST(ObjCases, TiffBmpAndTgaMapsAreKeptAsPng) {
  const std::vector<std::uint8_t> pixels{255, 0, 0, 0, 0, 255};
  for (const std::string& picture : {tiff_of(pixels), bmp_of(pixels, 2), tga_of(pixels, 2)}) {
    const auto read =
        read_case({.file = dressed("mtllib m.mtl"),
                   .beside = {{"m.mtl", "newmtl m\nmap_Kd t.x\n"}, {"t.x", picture}}});
    EXPECT_THAT(read.mesh.attributes.colours, ::testing::Each(kRed));
    ASSERT_EQ(read.texturing.pictures.size(), 1u);
    const auto kept = decode_picture(read.texturing.pictures[0].bytes, 2);
    ASSERT_TRUE(kept) << kept.error().message;
    EXPECT_THAT(kept->pixels, ElementsAre(255, 0, 0, 255, 0, 0, 255, 255));
    EXPECT_THAT(read.repairs, ::testing::Contains("1 texture map kept as PNG: TIFF, BMP and TGA "
                                                  "files are not kept themselves; archive them "
                                                  "with the mesh"));
  }
}

TEST(ObjCases, ABlackMaterialShowsItsEmission) {
  expect_statement("Kd 0 0 0\nmap_Ke t a.png", kAllRed);
  expect_statement("kd 0 0 0\nKe 1 1 1\nmap_Ke -o 0.5 t a.png", kAllBlue);
  expect_case({.situation = "without a picture",
               .file = dressed("mtllib m.mtl"),
               .colours = kAllRed,
               .said = "colours of 1 material baked",
               .beside = {{"m.mtl", "newmtl m\nKd 0 0 0\nKe 1 0 0\n"}}});
}

std::vector<Case> empty_last_fields() {
  const std::string pentagon =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 1.5 0\nv 0 1 0\nv 0.5 0.5 1\n"
      "f 5// 4// 3// 2// 1//\nf 1 2 6\nf 2 3 6\nf 3 4 6\nf 4 5 6\nf 5 1 6\n";
  const std::vector<Triangle> one{{0, 2, 1}};
  return {{.situation = "a pentagon",
           .file = pentagon,
           .faces = 8,
           .triangles = {{0, 1, 5},
                         {1, 2, 5},
                         {2, 3, 5},
                         {3, 4, 5},
                         {4, 0, 5},
                         {4, 3, 2},
                         {4, 2, 1},
                         {4, 1, 0}}},
          {.situation = "one slash",
           .file = kObjCorners + "f 1/ 3/ 2/\n",
           .faces = 1,
           .triangles = one},
          {.situation = "tabs",
           .file = kObjCorners + "f 1//\t3//\t2//\t\n",
           .faces = 1,
           .triangles = one}};
}

// Returns a case whose material refers to the map "t.png" in the statement `statement`.
Case map_case(const std::string& statement) {
  return {.situation = statement,
          .file = dressed("mtllib m.mtl"),
          .colours = kAllRed,
          .said = "1 texture map baked",
          .beside = {{"m.mtl", "newmtl m\nKd 0.8 0.8 0.8\n" + statement + "\n"},
                     {"t.png", red_and_blue()}}};
}

std::vector<Case> missing_materials() {
  const std::map<std::string, std::string> beside{{"a.mtl", "newmtl n\nKd 0 0 1\n"}};
  const std::string said = "1 material not in the material library, such as 'm'";
  return {{.situation = "of all faces",
           .file = dressed("mtllib a.mtl"),
           .said = said,
           .beside = beside},
          {.situation = "of some faces",
           .file = dressed("mtllib a.mtl") + "usemtl n\nf 1 3 2\n",
           .faces = 5,
           .colours = {kBlue, kBlue, kBlue, kWhiteCase},
           .said = said,
           .beside = beside},
          {.situation = "of an empty library",
           .file = dressed("mtllib a.mtl"),
           .said = said,
           .beside = {{"a.mtl", "# empty\n"}}}};
}

std::vector<Case> missing_libraries() {
  const std::string said =
      "1 material not carried, such as 'm': the file names no material library";
  const std::string red = "newmtl m\nKd 1 0 0\n";
  return {{.situation = "none is there", .file = dressed(""), .said = said},
          {.situation = "one lies beside the file",
           .file = dressed("# a.mtl"),
           .said = said,
           .beside = {{"a.mtl", red}}},
          {.situation = "it is named after the faces",
           .file = dressed("") + "mtllib a.mtl\n",
           .said = said,
           .beside = {{"a.mtl", red}}}};
}

// Returns a case whose material library, m.mtl, consists of the text `library`.
Case library_case(const std::string& library, const std::vector<Colour>& colours,
                  const std::string& said) {
  return {.situation = library,
          .file = dressed("mtllib m.mtl"),
          .colours = colours,
          .said = said,
          .beside = {{"m.mtl", library}}};
}

std::vector<Case> colours_of_libraries() {
  const std::string material = "newmtl m\n";
  const std::vector<Colour> white(4, kWhiteCase), grey(4, Colour{128, 128, 128});
  const std::string lost = "colours of 1 material not carried: ";
  return {library_case(material + "Kd 0.5\n", grey, "colours of 1 material baked"),
          library_case(material + "Kd 120 80 40\n", std::vector<Colour>(4, {120, 80, 40}),
                       "colours of 1 material read as 0 to 255"),
          library_case(material + "Kd 255 0 0\nnewmtl n\nKd 1 1 1\n", kAllRed, "read as 0 to 255"),
          library_case(material + "Kd 1.1 -0.1 0\n", kAllRed, "clipped to the range 0 to 1"),
          library_case(material + "Kd 0,5 0,0 0,0\n", white, lost + "numbers have decimal commas"),
          library_case(material + "Kd xyz 0.4 0.2 0.1\n", white,
                       lost + "Kd is not red, green and blue"),
          library_case(material + "Kd spectral a.rfl\n", white,
                       lost + "Kd is not red, green and blue")};
}

std::vector<Case> encodings_of_libraries() {
  using std::string_literals::operator""s;
  const std::string said = "'m.mtl' not carried: it is text in UTF-16; save it as UTF-8";
  return {library_case("\xEF\xBB\xBFnewmtl m\nKd 1 0 0\n", kAllRed, "colours of 1 material baked"),
          library_case("\xFF\xFEn\0e\0w\0"s, {}, said),
          library_case("\xFE\xFF\0n\0e\0w"s, {}, said)};
}

std::vector<Case> ambient_maps() {
  const std::string said = "1 kind of material maps not carried: map_Ka; bake them";
  const std::vector<Colour> white(4, kWhiteCase);
  return {library_case("newmtl m\nmap_Ka t.png\n", white, said),
          library_case("newmtl m\nKd 1 0 0\nMAP_KA t.png\n", kAllRed, said),
          map_case("map_Ka t.png\nmap_Kd t.png")};
}

std::vector<Case> names_with_more() {
  std::string commented = dressed("mtllib m.mtl");
  commented.insert(commented.find('\n', commented.find("usemtl")), " # comment");
  return {
      map_case("map_Kd t.png # comment"),
      map_case("map_Kd -s 1 1 1 t.png\t #"),
      {.situation = "a library in quotation marks",
       .file = dressed("mtllib \"my a.mtl\""),
       .colours = kAllRed,
       .said = "colours of 1 material baked",
       .beside = {{"my a.mtl", "newmtl m\nKd 1 0 0\n"}}},
      {.situation = "a picture's name as in a URI",
       .file = dressed("mtllib m.mtl"),
       .colours = kAllRed,
       .said = "1 texture map baked",
       .beside = {{"m.mtl", "newmtl m\nmap_Kd b%20c.png\n"}, {"b c.png", png_of({255, 0, 0}, 1)}}},
      {.situation = "a comment behind usemtl",
       .file = commented,
       .colours = kAllRed,
       .said = "colours of 1 material baked",
       .beside = {{"m.mtl", "newmtl m\nKd 1 0 0\n"}}}};
}

std::vector<Case> missing_colours() {
  const std::string said = "1 colour missing or not a number, white instead";
  return {{.situation = "not on each line",
           .file = painted({"1 0 0", "", "0 0 1", "1 1 1"}),
           .colours = {kRedCase, kWhiteCase, kBlueCase, kWhiteCase},
           .said = said},
          {.situation = "not a number",
           .file = painted({"1 0 0", "nan 1 0", "0 0 1", "1 1 1"}),
           .colours = {kRedCase, kWhiteCase, kBlueCase, kWhiteCase},
           .said = said},
          {.situation = "below 0",
           .file = painted({"1 0 0", "-0.1 1 nan", "0 0 1", "1 1 1"}),
           .colours = {kRedCase, kGreenCase, kBlueCase, kWhiteCase},
           .said = "2 colour values below 0 or not a number became 0"}};
}

}  // namespace

std::vector<testing::FileKind> testing::obj_kinds() {
  return {{"wings_pentagon.obj", empty_last_fields()},
          {"colour_over_1.obj", colours_above_1()},
          {"colour_rgba.obj", colours_of_four_numbers()},
          {"mrgb.obj", paint_of_zbrush()},
          {"map_kd.obj",
           {map_case("map_kd t.png"), map_case("MAP_KD t.png"), map_case("Map_kD T.PNG")}},
          {"missing_material.obj", missing_materials()},
          {"no_mtllib.obj", missing_libraries()},
          {"kd_of_mtl.obj", colours_of_libraries()},
          {"bom_of_mtl.obj", encodings_of_libraries()},
          {"map_ka.obj", ambient_maps()},
          {"map_comment.obj", names_with_more()},
          {"colour_missing.obj", missing_colours()},
          {"statements.obj", other_statements()}};
}

}  // namespace vitrine
