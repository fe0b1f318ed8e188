// SPDX-License-Identifier: Apache-2.0
#include "codec/files/companions.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

TEST(Companions, ThePartsOfAPathEndAtSlashesOfBothKinds) {
  EXPECT_EQ(companion_key("maps/My Skin.PNG"), "my skin.png");
  EXPECT_EQ(companion_key("C:\\scans\\maps\\Skin.png"), "skin.png");
}

TEST(Companions, NamesInWindows1252AreThoseInUtf8) {
  EXPECT_EQ(companion_key("B\xFCste.png"), "b\xC3\xBCste.png");
  EXPECT_EQ(companion_key("maps\\\x80 \x96 \xE9.jpg"), "\xE2\x82\xAC \xE2\x80\x93 \xC3\xA9.jpg");
  EXPECT_EQ(companion_key("cut\xC3"), "cut\xC3\x83");
  EXPECT_EQ(companion_key("b\xC3\xBCste \xE5\x83\x8F \xF0\x9F\x97\xBF.png"),
            "b\xC3\xBCste \xE5\x83\x8F \xF0\x9F\x97\xBF.png");
}

}  // namespace
}  // namespace vitrine
