// SPDX-License-Identifier: Apache-2.0
// OFF files in the style of real programs.
#include "cases/kind.h"

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using vitrine::testing::Case;
using vitrine::testing::expect_case;
using vitrine::testing::kFourCases;
using vitrine::testing::kRedCase;
using vitrine::testing::refusal;

// Returns a tetrahedron as OFF: the start of the file, then the vertices and the faces. vertices[i]
// follows the coordinates of vertex i, and faces[i] follows the corners of face i.
std::string off(const std::string& start, const std::array<std::string, 4>& vertices = {},
                const std::array<std::string, 4>& faces = {}) {
  std::string out = start + "\n";
  const char *corners[] = {"0 0 0 ", "1 0 0 ", "0 1 0 ", "0 0 1 "},
             *triangles[] = {"3 0 2 1 ", "3 0 1 3 ", "3 1 2 3 ", "3 2 0 3 "};
  for (std::size_t v = 0; v < 4; ++v)
    out += corners[v] + vertices[v] + "\n";
  for (std::size_t f = 0; f < 4; ++f)
    out += triangles[f] + faces[f] + "\n";
  return out;
}

TEST(OffCases, AreReadWithAnyKeyword) {
  for (const std::string start :
       {"OFF4 4 0", "OFF4 4", "off\n4 4 0", "Off 4 4 6", "4 4 0", "# made by hand\n4 4 6 # bare"})
    expect_case({.situation = start, .file = off(start)});
}

constexpr const char* kCoordinatesLost = "4 texture coordinates not carried; OFF names no picture";
const std::array<std::string, 4> kRgba{"255 0 0 255 ", "0 255 0 255 ", "0 0 255 255 ",
                                       "200 200 0 255 "};

// Returns kRgba with `before` in front of each entry and `after` behind it.
std::array<std::string, 4> around_rgba(const std::string& before, const std::string& after) {
  std::array<std::string, 4> out = kRgba;
  for (std::string& numbers : out)
    numbers = before + numbers + after;
  return out;
}

std::vector<Case> orders_of_letters() {
  return {{.situation = "MeshLab, colours and coordinates",
           .file = off("CSTOFF\n4 4 0", around_rgba("", "0 0")),
           .colours = kFourCases,
           .said = kCoordinatesLost},
          {.situation = "MeshLab, colours before normals",
           .file = off("NCOFF\n4 4 0", around_rgba("", "0 -1 0")),
           .colours = kFourCases},
          {.situation = "MeshLab, all",
           .file = off("NCSTOFF\n4 4 0", around_rgba("", "0 -1 0 0.5 0.5")),
           .colours = kFourCases,
           .said = kCoordinatesLost},
          {.situation = "MeshLab, promised normals that are absent",
           .file = off("NCOFF\n4 4 0", kRgba),
           .colours = kFourCases},
          {.situation = "lower case, normals first",
           .file = off("cnoff 4 4 0", around_rgba("0 -1 0 ", "")),
           .colours = kFourCases}};
}

TEST(OffCases, ColoursUnderAPlainKeyword) {
  const std::vector<Case> cases{
      {.situation = "0 to 255 with opacity",
       .file = off("OFF\n4 4 0", kRgba),
       .colours = kFourCases},
      {.situation = "opacity of one",
       .file = off("COFF\n4 4 0", {"255 0 0 255", "0 255 0 255", "0 0 255 254", "200 200 0 255"}),
       .colours = kFourCases,
       .said = "opacity of 1 colour not carried: vertex colours are opaque; "},
      {.situation = "opacity of a face",
       .file = off("OFF\n4 4 0", {}, {"1.0 0 0 1", "1.0 0 0 1", "1.0 0 0 0.5", "1.0 0 0 1"}),
       .colours = std::vector(4, kRedCase),
       .said = "opacity of 1 colour not carried"},
      {.situation = "0 to 1",
       .file = off("OFF\n4 4 0", {"1 0 0", "0 1 0", "0 0 1", "0.7843 0.7843 0"}),
       .colours = kFourCases},
      {.situation = "normals",
       .file = off("OFF\n4 4 0", {"0 0 -1", "0 0 -1", "0 0 1", "0 0 1"}),
       .said = "numbers after the coordinates of 4 lines not carried: they are no colours"}};
  for (const Case& expected : cases)
    expect_case(expected);
}

std::vector<Case> colours_of_faces() {
  return {{.situation = "0 to 255",
           .file = off("OFF\n4 4 0", {}, {"255 0 0", "255 0 0", "255 0 0", "0 0 255"}),
           .colours = {{213, 0, 156}, kRedCase, {213, 0, 156}, {213, 0, 156}},
           .said = "colours of 4 faces averaged at the vertices"},
          {.situation = "0 to 1, the same for all",
           .file = off("OFF\n4 4 0", {}, {"1.0 0 0 1", "1.0 0 0 1", "1.0 0 0 1", "1.0 0 0 1"}),
           .colours = std::vector(4, kRedCase)},
          {.situation = "vertices have colours",
           .file = off("COFF\n4 4 0", kRgba, {"255 0 0", "255 0 0", "", ""}),
           .colours = kFourCases,
           .said = "colours of 2 faces not carried: the vertices have colours of their own"},
          {.situation = "numbers of a colour map",
           .file = off("OFF\n4 4 0", {}, {"7", "7", "7", "7"}),
           .said = "colours of 4 faces not carried: they are numbers of a colour map"}};
}

std::vector<Case> glued_counts() {
  return {{.situation = "OFF", .file = off("OFF4 4 0")},
          {.situation = "OFF, without the count of edges", .file = off("OFF4 4")},
          {.situation = "COFF", .file = off("COFF4 4 0", kRgba), .colours = kFourCases}};
}

TEST(OffCases, DecimalCommasAreNamed) {
  EXPECT_EQ(refusal("OFF\n3 1 0\n0,5 0,0 1,0\n1 0 0\n0 1 0\n3 0 1 2\n"),
            "OFF line 3: numbers have decimal commas; write them with points");
  EXPECT_THAT(refusal("OFF\n3 1 0\n0 0 0\n1 -2,25 0\n0 1 0\n3 0 1 2\n"),
              HasSubstr("OFF line 4: numbers have decimal commas"));
  EXPECT_THAT(refusal("COFF\n3 1 0\n0 0 0 0,5 0,5 0,5\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n"),
              HasSubstr("OFF line 3: numbers have decimal commas"));
}

TEST(OffCases, AMissingColourIsNamedWithItsLine) {
  EXPECT_THAT(refusal("COFF\n3 1 0\n0 0 0 1 1 1\n1 0 0 1 1\n0 1 0 1 1 1\n3 0 1 2\n"),
              HasSubstr("OFF line 4: vertex 1 lacks numbers"));
}

TEST(OffCases, OtherNumbersAreNoOff) {
  EXPECT_THAT(refusal("3 1 0\n4 5 6\n7 8 9\n"), HasSubstr("this is a list of points"));
  EXPECT_THAT(refusal("3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
              HasSubstr("this is a list of points"));
}

}  // namespace

std::vector<testing::FileKind> testing::off_kinds() {
  return {{"face_colour.off", colours_of_faces()},
          {"cstoff.off", orders_of_letters()},
          {"glued.off", glued_counts()}};
}

}  // namespace vitrine
