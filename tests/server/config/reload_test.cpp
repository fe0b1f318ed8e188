// SPDX-License-Identifier: Apache-2.0
#include "server/config/reload.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/config/options.h"

namespace vitrine::server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

CommandLine line_of(const std::string& file) {
  return parse_command_line(std::vector<std::string_view>{"--config", "v.conf"}, {},
                            [&](const std::string&) -> Expected<std::string> { return file; })
      .value();
}

TEST(Reload, AppliesReloadableKeysAndListsTheOthers) {
  const auto result = reload(line_of("threads = 2\nstop-timeout = 5\n"),
                             line_of("threads = 3\nstop-timeout = 6\npublic-url = https://a.b\n"));
  ASSERT_TRUE(result);
  EXPECT_THAT(result->changed, ElementsAre("stop-timeout", "public-url"));
  EXPECT_THAT(result->waiting, ElementsAre("threads"));
  EXPECT_EQ(result->line.settings.threads, 2u);
  EXPECT_EQ(result->line.settings.stop_timeout, std::chrono::seconds(6));
  EXPECT_EQ(result->line.settings.public_url, "https://a.b");
}

TEST(Reload, KeysThatNeedARestartAreListedEachTime) {
  const CommandLine fresh = line_of("threads = 3\n");
  const auto once = reload(line_of("threads = 2\n"), fresh);
  EXPECT_THAT(reload(once->line, fresh)->waiting, ElementsAre("threads"));
}

TEST(Reload, AKeyRemovedFromTheFileHasItsDefaultAgain) {
  const auto result = reload(line_of("stop-timeout = 5\n"), line_of(""));
  EXPECT_THAT(result->changed, ElementsAre("stop-timeout"));
  EXPECT_EQ(result->line.settings.stop_timeout, std::chrono::seconds(20));
  EXPECT_THAT(reload(result->line, line_of(""))->changed, IsEmpty());
}

TEST(Reload, KeysAreListedForPeople) {
  EXPECT_EQ(list_keys({}), "nothing");
  EXPECT_EQ(list_keys({"a", "b"}), "a, b");
}

TEST(PublicUrl, IsAnOriginAndPerhapsAPath) {
  const Option& option = *find_option("public-url");
  Settings settings;
  ASSERT_TRUE(option.apply(settings, "https://museum.example/3d/"));
  EXPECT_EQ(settings.public_url, "https://museum.example/3d");
  for (const char* text : {"", "http://[::1]:8080", "http://127.0.0.1"})
    EXPECT_TRUE(option.apply(settings, text)) << text;
  for (const char* text : {"museum.example", "https://", "ftp://a", "https://a b", "https://a\"",
                           "https://a?x", "https://a<"}) {
    EXPECT_FALSE(option.apply(settings, text)) << text;
  }
}

TEST(Contact, IsAnEmailAddressAsOaiPmhDefinesIt) {
  const Option& option = *find_option("contact");
  Settings settings;
  EXPECT_TRUE(option.apply(settings, "3d@museum.example"));
  EXPECT_EQ(settings.contact, "3d@museum.example");
  EXPECT_TRUE(option.apply(settings, ""));
  for (const char* wrong : {"museum.example", "@museum.example", "a@museum", "a@b.", "a@.b",
                            "a@b..c", "a b@museum.example", "a@"})
    EXPECT_FALSE(option.apply(settings, wrong)) << wrong;
}

}  // namespace
}  // namespace vitrine::server
