// SPDX-License-Identifier: Apache-2.0
#include "server/cli/client/model_url.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(ModelUrl, IsThatOfAPageOrOfTheApi) {
  for (const char* const text :
       {"http://host:8080/models/abc", "http://host:8080/models/abc/",
        "http://host:8080/api/v1/models/abc", "http://host:8080/models/abc?from=gallery#top"}) {
    const auto url = parse_model_url(text);
    ASSERT_TRUE(url) << text;
    EXPECT_EQ(url->host, "host");
    EXPECT_EQ(url->port, "8080");
    EXPECT_EQ(url->target, "/api/v1/models/abc/stream");
    EXPECT_EQ(url->authority(), "host:8080");
  }
}

TEST(ModelUrl, MayLieBelowAPathAndHaveAnAddressForAHost) {
  const auto below = parse_model_url("http://museum.example/scans/models/abc");
  ASSERT_TRUE(below);
  EXPECT_EQ(below->port, "80");
  EXPECT_EQ(below->target, "/scans/api/v1/models/abc/stream");
  const auto v6 = parse_model_url("http://[::1]:81/models/abc");
  ASSERT_TRUE(v6);
  EXPECT_EQ(v6->host, "::1");
  EXPECT_EQ(v6->authority(), "[::1]:81");
}

TEST(ModelUrl, MayBeEncrypted) {
  const auto url = parse_model_url("https://museum.example/models/abc");
  ASSERT_TRUE(url);
  EXPECT_TRUE(url->is_encrypted);
  EXPECT_EQ(url->port, "443");
  EXPECT_FALSE(parse_model_url("http://museum.example/models/abc")->is_encrypted);
}

TEST(ModelUrl, IsNothingElse) {
  for (const char* const text :
       {"", "models/abc", "ftp://host/models/abc", "http://host/", "http://host/models/",
        "http://host/models/a/b", "http:///models/abc", "http://user@host/models/abc",
        "http://host:x/models/abc", "http://host/models/a b", "http://host/models/a.pmesh"}) {
    EXPECT_FALSE(parse_model_url(text)) << text;
  }
  EXPECT_FALSE(parse_model_url("http://host/models/" + std::string(100'000, 'a')));
}

}  // namespace
}  // namespace vitrine::server
