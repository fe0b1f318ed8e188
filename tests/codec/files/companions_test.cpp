// SPDX-License-Identifier: Apache-2.0
#include "codec/files/companions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace vitrine {
namespace {

using ::testing::HasSubstr;

TEST(Companions, AKeyHasThePartsOfAPathInReverseOrder) {
  EXPECT_EQ(companion_key("maps/My Skin.PNG"), "my skin.png/maps");
  EXPECT_EQ(companion_key(".\\a\\..\\Maps//Skin.png"), "skin.png/maps");
  EXPECT_EQ(companion_key("C:\\scans\\Skin.png"), "skin.png/scans/c:");
  EXPECT_EQ(companion_key("../../a/Skin.png"), "skin.png/a/../..");
  EXPECT_EQ(companion_path("skin.png/a/../.."), "../../a/skin.png");
  EXPECT_EQ(companion_path("skin.png"), "skin.png");
}

std::span<const std::uint8_t> as_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Looks for the stated path among `files`. Returns the path of the file that is found, or the error
// message.
std::string found_among(const std::vector<std::string>& files, const StatedPath& stated) {
  Companions companions;
  for (const std::string& file : files)
    companions.emplace(companion_key(file), as_bytes(file));
  share_equal_contents(companions);
  const auto found = find_companion(companions, stated);
  return found ? companion_path((*found)->first) : found.error().message;
}

TEST(Companions, APathIsThatOfItsFileAndThenThatOfTheMesh) {
  const std::vector<std::string> files{"t.png", "a/t.png", "a/b/t.png", "b/t.png", "../b/t.png"};
  EXPECT_EQ(found_among(files, {"t.png"}), "t.png");
  EXPECT_EQ(found_among(files, {"A\\T.png"}), "a/t.png");
  EXPECT_EQ(found_among(files, {"../b/t.png"}), "../b/t.png");
  EXPECT_EQ(found_among(files, {"b/t.png", "a/"}), "a/b/t.png");
  EXPECT_EQ(found_among(files, {"b/t.png", "x/"}), "b/t.png");
  EXPECT_EQ(found_among(files, {"../t.png", "a/"}), "t.png");
}

TEST(Companions, APathOfAnotherMachineIsComparedFromItsEnd) {
  const std::vector<std::string> files{"body/maps/t.png", "head/maps/t.png", "hand/maps/u.png"};
  EXPECT_EQ(found_among(files, {"C:\\scan\\Head\\maps\\t.png"}), "head/maps/t.png");
  EXPECT_EQ(found_among(files, {"/home/me/u.png"}), "hand/maps/u.png");
}

TEST(Companions, TheFolderOfTheMeshCountsBeforeOthers) {
  EXPECT_EQ(found_among({"../t.png", "a/t.png", "t.png"}, {"/x/t.png"}), "t.png");
  EXPECT_EQ(found_among({"../t.png", "a/t.png", "../b/t.png"}, {"t.png"}), "a/t.png");
}

TEST(Companions, OfEquallyNearFilesThatWithTheShortestPathCounts) {
  EXPECT_EQ(found_among({"../a/old/t.png", "../a/t.png"}, {"C:\\x\\t.png"}), "../a/t.png");
  EXPECT_EQ(found_among({"a/b/t.png", "b/t.png"}, {"t.png"}), "b/t.png");
}

TEST(Companions, CopiesOfAFileAreNotAmbiguous) {
  const std::string one = "wood", copy = "wood", other = "moss";
  Companions companions{{"t.png/maps", as_bytes(one)}, {"t.png/web", as_bytes(copy)}};
  EXPECT_FALSE(find_companion(companions, {"t.png"}));
  share_equal_contents(companions);
  EXPECT_EQ(find_companion(companions, {"t.png"}).value()->first, "t.png/maps");
  companions.emplace("t.png/x", as_bytes(other));
  EXPECT_FALSE(find_companion(companions, {"t.png"}));
}

TEST(Companions, EncodingsOfAFolderAndAPathMayDiffer) {
  EXPECT_EQ(found_among({"k\xC3\xB6pfe/\xC3\xBC.png", "\xC3\xBC.png"},
                        {.path = "\xFC.png", .folder = "k\xC3\xB6pfe/"}),
            "k\xC3\xB6pfe/\xC3\xBC.png");
}

TEST(Companions, AnAmbiguousNameIsAFault) {
  EXPECT_EQ(found_among({"body/t.png", "head/t.png", "t.png.txt"}, {"t.png"}),
            "has the name of 2 files beside the mesh file, such as 'body/t.png' and 'head/t.png'; "
            "state the path of one of them, or give the files different names");
  std::vector<std::string> many;
  for (int i = 0; i < 300; ++i)
    many.push_back(std::to_string(i) + "/t.png");
  EXPECT_THAT(found_among(many, {"x/7/t.png"}), HasSubstr("has the name of 257 files"));
  EXPECT_EQ(found_among(many, {"299/t.png"}), "299/t.png");
  EXPECT_EQ(found_among({"a.png"}, {"t.png"}),
            "is not beside the mesh file; copy it there, or pack both in one zip");
}

TEST(Companions, NamesInWindows1252AreThoseInUtf8) {
  EXPECT_EQ(name_key("B\xFCste.png"), "b\xC3\xBCste.png");
  EXPECT_EQ(name_key("maps\\\x80 \x96 \xE9.jpg"), "\xE2\x82\xAC \xE2\x80\x93 \xC3\xA9.jpg");
  EXPECT_EQ(name_key("cut\xC3"), "cut\xC3\x83");
  EXPECT_EQ(name_key("b\xC3\xBCste \xE5\x83\x8F \xF0\x9F\x97\xBF.png"),
            "b\xC3\xBCste \xE5\x83\x8F \xF0\x9F\x97\xBF.png");
}

// macOS stores an accented letter as two characters: the letter and a combining mark.
TEST(Companions, NamesOfMacOsAreThoseOfOtherSystems) {
  const std::pair<const char*, const char*> names[] = {
      {"Bu\xCC\x88ste.png", "b\xC3\xBCste.png"},             // ü
      {"e\xCC\xA3\xCC\x82.png", "\xE1\xBB\x87.png"},         // two marks on one letter
      {"\xD0\xB8\xCC\x86.png", "\xD0\xB9.png"},              // й
      {"\xE3\x81\x8B\xE3\x82\x99.png", "\xE3\x81\x8C.png"},  // が
  };
  for (const auto& [apart, joined] : names) {
    EXPECT_EQ(name_key(apart), joined);
    EXPECT_EQ(companion_key(std::string("maps/") + apart),
              companion_key(std::string("maps/") + joined));
  }
  EXPECT_EQ(name_key("\xCC\x88.png"), "\xCC\x88.png");    // a mark without a letter
  EXPECT_EQ(name_key("q\xCC\x88.png"), "q\xCC\x88.png");  // Unicode has no q with this mark
}

}  // namespace
}  // namespace vitrine
