// SPDX-License-Identifier: Apache-2.0
#include "server/messages/download_name.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(DownloadName, AnAsciiTitleNamesTheFile) {
  EXPECT_EQ(attachment_named("Bust of a man", "m1", "obj.zip"),
            "attachment; filename=\"Bust of a man.obj.zip\"");
}

TEST(DownloadName, OtherCharactersAreInUtf8AsWell) {
  EXPECT_EQ(attachment_named("Bü\u4E00", "m1", "glb"),
            "attachment; filename=\"B__.glb\"; filename*=UTF-8''B%C3%BC%E4%B8%80.glb");
}

TEST(DownloadName, NoTitleLeavesTheFolderOrTheHeader) {
  EXPECT_EQ(attachment_named("../a\r\nX: \"b\"\\c", "m1", "glb"),
            "attachment; filename=\"_a__X_ _b__c.glb\"");
  EXPECT_EQ(attachment_named("a\u202Ebgl\u0085", "m1", "exe"),
            "attachment; filename=\"a_bgl_.exe\"");
}

TEST(DownloadName, WithoutATitleTheFallbackNamesTheFile) {
  for (const char* title : {"", " . ", "..."})
    EXPECT_EQ(attachment_named(title, "m1", "ply"), "attachment; filename=\"m1.ply\"");
}

TEST(DownloadName, ALongTitleIsCutBetweenCharacters) {
  std::string title = "a";
  for (int i = 0; i < 100; ++i)
    title += "ü";
  const std::string value = attachment_named(title, "m1", "ply");
  std::size_t encoded = 0;
  for (std::size_t at = 0; (at = value.find("%C3%BC", at)) != value.npos; ++at)
    ++encoded;
  EXPECT_EQ(encoded, 59u);
  EXPECT_TRUE(value.ends_with("%C3%BC.ply"));
}

}  // namespace
}  // namespace vitrine::server
