// SPDX-License-Identifier: Apache-2.0
#include "server/messages/query.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(SplitTarget, PartsPathAndQuery) {
  const auto target = split_target("/a/b?c=d?e");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/a/b");
  EXPECT_EQ(target->query, "c=d?e");
}

TEST(SplitTarget, TakesTheOriginOffAnAbsoluteTarget) {
  EXPECT_EQ(split_target("http://host:80/a?x=1")->path, "/a");
  EXPECT_EQ(split_target("/go?to=http://b/c")->path, "/go");
}

TEST(SplitTarget, RefusesWhatHasNoPath) {
  EXPECT_FALSE(split_target("*"));
  EXPECT_FALSE(split_target("host:443"));
  EXPECT_FALSE(split_target("http://host"));
  EXPECT_FALSE(split_target(""));
}

TEST(Query, DecodesEscapesAndSpaces) {
  const auto query = Query::parse("q=a+b%20%C3%A9&empty=&flag&q=second");
  ASSERT_TRUE(query);
  EXPECT_EQ(query->get("q"), "a b \xC3\xA9");
  EXPECT_EQ(query->get("empty"), "");
  EXPECT_EQ(query->get("flag"), "");
  EXPECT_EQ(query->get("none"), std::nullopt);
}

TEST(DecodePath, TakesEscapesButNoPlusForASpace) {
  EXPECT_EQ(decode_path("a+b%20%C3%A9%2F"), "a+b \xC3\xA9/");
  EXPECT_EQ(decode_path("a%2"), std::nullopt);
}

TEST(Query, KnowsWhichParameterIsGivenTwice) {
  EXPECT_EQ(Query::parse("a=1&b=2&a=1&b=3")->repeated(), "a");
  EXPECT_EQ(Query::parse("a=1&b=1")->repeated(), std::nullopt);
}

TEST(Query, RefusesMalformedEscapesAndTooManyParameters) {
  for (const char* text : {"q=%", "q=%1", "q=%zz", "q=%-1", "%"})
    EXPECT_FALSE(Query::parse(text)) << text;
  std::string many;
  for (std::size_t i = 0; i <= Query::kMaxParameters; ++i)
    many += "a=b&";
  EXPECT_FALSE(Query::parse(many));
}

}  // namespace
}  // namespace vitrine::server
