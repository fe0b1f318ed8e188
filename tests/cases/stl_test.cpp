// SPDX-License-Identifier: Apache-2.0
// STL files in the style of real programs.
#include <algorithm>

#include "cases/kind.h"
#include "codec/export/write_mesh.h"

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using vitrine::testing::as_text;
using vitrine::testing::bytes_of;
using vitrine::testing::Case;
using vitrine::testing::expect_case;
using vitrine::testing::kBlueCase;
using vitrine::testing::kGreenCase;
using vitrine::testing::kRedCase;
using vitrine::testing::kWhiteCase;
using vitrine::testing::read_text;
using vitrine::testing::refusal;
using vitrine::testing::tetrahedron;

// Returns a tetrahedron as binary STL. The header starts with `header` and states `count` facets.
// attributes[i] becomes the last two bytes of facet i.
std::string binary_stl(std::uint32_t count, const std::string& header = "binary",
                       const std::vector<std::uint16_t>& attributes = {}) {
  std::string file = as_text(*write_mesh(tetrahedron(), MeshFormat::kStl));
  file.replace(0, 84, header + std::string(80 - header.size(), '\0') + bytes_of({count}));
  for (std::size_t f = 0; f < attributes.size(); ++f)
    file.replace(84 + 50 * f + 48, 2, bytes_of({attributes[f]}));
  return file;
}

// Returns the binary STL `file` with the normal (0, 0, z) in all four facets.
std::string with_normals(std::string file, float z) {
  for (std::size_t f = 0; f < 4; ++f)
    file.replace(84 + 50 * f, 12, bytes_of<float>({0, 0, z}));
  return file;
}

std::vector<Case> counts_of_facets() {
  const std::string blanks(80, ' ');
  return {{.situation = "count too small",
           .file = binary_stl(2),
           .said = "4 facets read by the file's size, though its header counts 2; "},
          {.situation = "count 1 and a tail",
           .file = binary_stl(1) + "tail",
           .said = "header counts 1; "},
          {.situation = "count 0", .file = binary_stl(0), .said = "header counts 0; "},
          {.situation = "all ones", .file = binary_stl(~0u), .said = "header counts 4294967295; "},
          {.situation = "blanks",
           .file = binary_stl(0x20202020, blanks),
           .said = "header counts 538976288; "},
          {.situation = "solid and blanks",
           .file = binary_stl(0x20202020, "solid" + blanks.substr(5)),
           .said = "header counts 538976288; "},
          {.situation = "count 0 and a line feed",
           .file = binary_stl(0) + "\n",
           .said = "4 facets read by the file's size, and 1 byte after them not, though its header "
                   "counts 0; compare"},
          {.situation = "all ones and padding",
           .file = binary_stl(~0u) + std::string(12, '\0'),
           .said = "and 12 bytes after them not, though its header counts 4294967295; "},
          {.situation = "zeros after the facets",
           .file = binary_stl(4) + std::string(100, '\0'),
           .said = "100 bytes after the counted facets are no facets"},
          {.situation = "a text after the facets",
           .file = binary_stl(4) + std::string(60, 'q'),
           .said = "60 bytes after the counted facets are no facets"},
          {.situation = "count too small and long normals",
           .file = with_normals(binary_stl(2), 25),
           .said = "4 facets read by the file's size, though its header counts 2; "},
          {.situation = "count too small and infinite normals",
           .file = with_normals(binary_stl(2), testing::kInfinity),
           .said = "header counts 2; "},
          {.situation = "count 0 and long normals",
           .file = with_normals(binary_stl(0), 25),
           .said = "header counts 0; "},
          {.situation = "all ones and long normals",
           .file = with_normals(binary_stl(~0u), 25),
           .said = "header counts 4294967295; "}};
}

std::vector<Case> files_cut_short() {
  const std::string whole = binary_stl(4);
  return {{.situation = "count too large",
           .file = binary_stl(9),
           .said = "4 facets read by the file's size, though its header counts 9; the file may be "
                   "cut short: compare the model with its source"},
          {.situation = "the largest credible count",
           .file = binary_stl(500'000'000),
           .said = "header counts 500000000; the file may be cut short: "},
          {.situation = "the last byte is missing",
           .file = whole.substr(0, whole.size() - 1),
           .faces = 3,
           .said = "3 facets read by the file's size, and 49 bytes after them not, though its "
                   "header counts 4; the file may be cut short: "},
          {.situation = "solid in the header",
           .file = binary_stl(9, "solid x"),
           .said = "header counts 9; "},
          {.situation = "numbers that are no unit normals",
           .file = with_normals(binary_stl(9), 25),
           .refused = "the STL file is cut short: only 4 of 9 triangles are there; copy it again"}};
}

// Text that is read as binary facets gives plausible small floats.
TEST(StlCases, TextOfNumbersIsNoFacets) {
  const std::string text = "OFF 3 1 0" + std::string(80, ' ') + "\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (std::size_t blanks = 0; blanks < 50; ++blanks)
    expect_case({.situation = std::to_string(blanks) + " blanks at the end",
                 .file = text + std::string(blanks, ' '),
                 .faces = 1});
}

constexpr std::uint16_t kVisCamRed = 0xFC00, kVisCamBlue = 0x801F;
constexpr std::uint16_t kMagicsRed = 0x001F, kMagicsGreen = 0x03E0, kMagicsDefault = 0x8000;

std::vector<Case> colours_of_facets() {
  const std::string green = "COLOR=" + bytes_of<std::uint8_t>({0, 255, 0, 255});
  return {
      {.situation = "VisCAM, one colour",
       .file = binary_stl(4, "x", std::vector(4, kVisCamBlue)),
       .colours = std::vector(4, kBlueCase)},
      {.situation = "VisCAM, one facet coloured",
       .file = binary_stl(4, "x", {kVisCamRed}),
       .colours = {kRedCase, kRedCase, kRedCase, {255, 255, 255}}},
      {.situation = "VisCAM, two colours",
       .file = binary_stl(4, "x", {kVisCamRed, kVisCamBlue}),
       .colours = {{188, 0, 188}, kRedCase, {188, 0, 188}, kBlueCase},
       .said = "colours of 2 faces averaged at the vertices"},
      {.situation = "Magics",
       .file = binary_stl(4, green, std::vector(4, kMagicsRed)),
       .colours = std::vector(4, kRedCase)},
      {.situation = "Magics, the object's colour",
       .file = binary_stl(4, "x " + green,
                          {kMagicsDefault, kMagicsGreen, kMagicsDefault, kMagicsDefault}),
       .colours = std::vector(4, kGreenCase)},
      {.situation = "Magics, without facet colours",
       .file = binary_stl(4, green),
       .colours = std::vector(4, kGreenCase)},
      {.situation = "no flag and no object's colour",
       .file = binary_stl(4, "x", {kMagicsRed, 0, kMagicsGreen}),
       .said = "attribute bytes of 2 facets not carried: nothing in the file says that they are "
               "colours; to keep colours, export PLY or OBJ"},
      {.situation = "VisCAM, a facet without the flag",
       .file = binary_stl(4, "x", {kVisCamRed, kMagicsGreen}),
       .colours = {kRedCase, kRedCase, kRedCase, kWhiteCase},
       .said = "attribute bytes of 1 facet not carried"}};
}

// Writes a tetrahedron as text STL with the given spelling of each statement.
struct Spelling {
  std::string solid = "solid x", normal = "normal 0 0 0", outer = "outer loop",
              loop_end = "endloop", facet_end = "endfacet", solid_end = "endsolid x";

  std::string file() const {
    std::string out = solid + "\n";
    for (const char* corners :
         {"0 0 0|0 1 0|1 0 0", "0 0 0|1 0 0|0 0 1", "1 0 0|0 1 0|0 0 1", "0 1 0|0 0 0|0 0 1"}) {
      out += "facet " + normal + "\n" + outer + "\nvertex " + corners + "\n" + loop_end + "\n" +
             facet_end + "\n";
      for (std::size_t at = 0; (at = out.find('|', at)) != out.npos;)
        out.replace(at, 1, "\nvertex ");
    }
    return out + solid_end + "\n";
  }
};

std::string with_fortran_numbers(std::string file) {
  for (std::size_t at = 0; (at = file.find("vertex 1 0", at)) != file.npos;)
    file.replace(at, 10, "vertex 1.0D+00 0.0d0");
  return file;
}

TEST(StlCases, AnExponentOfFortranCounts) {
  std::string file = Spelling{}.file();
  for (std::size_t at = 0; (at = file.find("vertex 1 0", at)) != file.npos;)
    file.replace(at, 10, "vertex 2.5D+01 -0.5d-1");
  EXPECT_EQ(read_text(file).mesh.positions,
            (std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {25, -0.05, 0}, {0, 0, 1}}));
}

std::vector<Case> spellings() {
  return {{.situation = "end loop", .file = Spelling{.loop_end = "end loop"}.file()},
          {.situation = "END FACET", .file = Spelling{.facet_end = "END FACET"}.file()},
          {.situation = "end solid", .file = Spelling{.solid_end = "end solid"}.file()},
          {.situation = "outerloop", .file = Spelling{.outer = "outerloop"}.file()},
          {.situation = "name after endsolid without a blank",
           .file = Spelling{.solid_end = "endsolidNAME"}.file()},
          {.situation = "name after solid without a blank",
           .file = Spelling{.solid = "solidNAME"}.file()},
          {.situation = "exponents of Fortran", .file = with_fortran_numbers(Spelling{}.file())},
          {.situation = "sOLID", .file = Spelling{.solid = "sOLID"}.file()},
          {.situation = "colour after endfacet",
           .file = Spelling{.facet_end = "endfacet 1.0 0.0 0.0"}.file(),
           .colours = std::vector(4, kRedCase)},
          {.situation = "colour from 0 to 255",
           .file = Spelling{.facet_end = "endfacet 0 0 255 255"}.file(),
           .colours = std::vector(4, kBlueCase)},
          {.situation = "color",
           .file = Spelling{.facet_end = "color 0 1 0\nendfacet"}.file(),
           .colours = std::vector(4, kGreenCase)}};
}

std::vector<Case> normals_without_numbers() {
  return {
      {.situation = "1.#QNAN", .file = Spelling{.normal = "normal 1.#QNAN 1.#QNAN 1.#QNAN"}.file()},
      {.situation = "-1.#IND",
       .file = Spelling{.normal = "normal -1.#IND -nan(ind) 1.#INF"}.file()},
      {.situation = "no normal", .file = Spelling{.normal = ""}.file()}};
}

// Files with decimal commas: STL with commas in coordinates and normals, OBJ, and OFF.
std::vector<Case> decimal_commas() {
  const std::string named = "numbers have decimal commas; write them with points";
  return {{.situation = "STL",
           .file = "solid x\nfacet normal 0,0 0,0 1,0\nouter loop\nvertex 0,5 0,0 0,0\n",
           .refused = "STL line 4: " + named},
          {.situation = "OBJ", .file = "v 0,5 0,0 1,0\n", .refused = "OBJ line 1: " + named},
          {.situation = "OFF",
           .file = "OFF\n3 1 0\n0,5 0,0 1,0\n1 0 0\n0 1 0\n3 0 1 2\n",
           .refused = "OFF line 3: " + named}};
}

TEST(StlCases, DecimalCommasAreNamed) {
  const std::string file = "solid x\nfacet normal 0,0 0,0 1,0\nouter loop\nvertex 0,5 0,0 0,0\n";
  EXPECT_EQ(refusal(file), "STL line 4: numbers have decimal commas; write them with points");
  EXPECT_THAT(refusal("solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 -2,5 0\n"),
              HasSubstr("STL line 4: numbers have decimal commas"));
}

std::vector<Case> texts_without_an_end() {
  const std::string whole = Spelling{}.file(), end = Spelling{}.solid_end + "\n";
  const std::string solid = whole.substr(0, whole.size() - end.size());
  const auto cut_before = [&](const std::string& word) {
    return whole.substr(0, whole.rfind(word));
  };
  const std::string said =
      " read from a text without endsolid at its end; the file may be cut "
      "short: compare the model with its source";
  return {
      {.situation = "no endsolid", .file = solid, .said = "4 facets" + said},
      {.situation = "no line feed", .file = cut_before("\nendsolid"), .said = "4 facets" + said},
      {.situation = "within a word",
       .file = cut_before("loop\nendfacet"),
       .faces = 3,
       .said = "3 facets" + said},
      {.situation = "within a corner",
       .file = cut_before(" 0 1\nendloop"),
       .faces = 3,
       .said = "3 facets" + said},
      {.situation = "within a number",
       .file = cut_before("0 1\nendloop") + "-",
       .faces = 3,
       .said = "3 facets" + said},
      {.situation = "after the colour of an incomplete facet",
       .file = cut_before("endloop") + "color 1 0 0\n",
       .faces = 3,
       .said = "3 facets" + said},
      {.situation = "after endfacet with a colour but without endloop",
       .file = cut_before("endloop") + "endfacet 1 0 0\n",
       .faces = 3,
       .said = "3 facets" + said},
      {.situation = "within the second solid",
       .file = whole + solid,
       .faces = 8,
       .said = "8 facets" + said},
      {.situation = "before the first facet ends",
       .file = whole.substr(0, whole.find("endloop")),
       .refused = "the STL file has no endsolid; it is cut short, copy it again"}};
}

std::vector<Case> solids_on_one_line() {
  const auto on_one_line = [](std::string text) {
    std::ranges::replace(text, '\n', ' ');
    return text;
  };
  const std::string solid = Spelling{}.file();
  return {{.situation = "one solid", .file = on_one_line(solid)},
          {.situation = "a name of three words",
           .file = on_one_line("solid my facet thing" + solid.substr(solid.find('\n')))},
          {.situation = "two solids", .file = on_one_line(solid + solid), .faces = 8}};
}

}  // namespace

std::vector<testing::FileKind> testing::stl_kinds() {
  return {{"count_2_of_4.stl", counts_of_facets()},
          {"end_loop.stl", spellings()},
          {"qnan_normal.stl", normals_without_numbers()},
          {"colour.stl", colours_of_facets()},
          {"comma.stl", decimal_commas()},
          {"cut_short.stl", files_cut_short()},
          {"no_endsolid.stl", texts_without_an_end()},
          {"one_line.stl", solids_on_one_line()}};
}

}  // namespace vitrine
