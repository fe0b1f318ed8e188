// SPDX-License-Identifier: Apache-2.0
#include "server/api/links.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Preview, StandsAtTheEndOfTheHead) {
  ModelRecord model;
  model.title = "Bust";
  const std::string html =
      with_links("<head><title>x</title></head><body></body>", model, "https://museum.example");
  EXPECT_THAT(html, HasSubstr("<title>x</title><meta property=\"og:title\" content=\"Bust\">"));
  EXPECT_THAT(html, HasSubstr("\n</head><body></body>"));
  EXPECT_THAT(html, HasSubstr("href=\"https://museum.example/api/v1/oembed?url=https%3A%2F%2F"
                              "museum.example%2Fmodels%2F" +
                              model.id.to_string() + "\""));
}

TEST(Preview, ATitleIsNoMarkup) {
  ModelRecord model;
  model.title = "\"><script>alert(1)</script>&";
  const std::string html = with_links("</head>", model, "");
  EXPECT_THAT(html, Not(HasSubstr("<script>")));
  EXPECT_THAT(html, HasSubstr("content=\"&quot;&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;\""));
}

TEST(Preview, AQueryTakesAnyText) {
  EXPECT_EQ(escape_query("a b&c=\xC3\xBC~"), "a%20b%26c%3D%C3%BC~");
}

}  // namespace
}  // namespace vitrine::server
