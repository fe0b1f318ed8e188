// SPDX-License-Identifier: Apache-2.0
#include "codec/core/html.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

TEST(Html, WhatHasAMeaningInMarkupIsEscapedAndAllElseStays) {
  EXPECT_EQ(escape_html("<a href=\"x\">'R & D'</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;R &amp; D&#39;&lt;/a&gt;");
  EXPECT_EQ(escape_html("Büste, 2 m"), "Büste, 2 m");
  EXPECT_EQ(escape_html("&amp;"), "&amp;amp;");
}

}  // namespace
}  // namespace vitrine
