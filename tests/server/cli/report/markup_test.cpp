// SPDX-License-Identifier: Apache-2.0
#include "server/cli/report/markup.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

std::string base64_of(const std::string& text) {
  return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(Markup, CharactersOfMarkupAreEscaped) {
  EXPECT_EQ(escaped("<b a=\"1\" c='2'>&</b>"),
            "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;&lt;/b&gt;");
}

TEST(Markup, BytesThatAreNoTextAreReplaced) {
  EXPECT_EQ(escaped("a\xFF"
                    "b\x01"
                    "c\n"
                    "d"),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD"
            "c\xEF\xBF\xBD"
            "d");
  EXPECT_EQ(escaped("b\xC3\xBCste.ply"), "b\xC3\xBCste.ply");
}

TEST(Markup, Base64IsThatOfRfc4648) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xFF\xFE\xFD"), "//79");
}

TEST(Markup, NumbersHaveThreeDigits) {
  EXPECT_EQ(significant(0), "0");
  EXPECT_EQ(significant(0.0123449), "0.0123");
  EXPECT_EQ(significant(0.99999), "1.00");
  EXPECT_EQ(significant(9.996), "10.0");
  EXPECT_EQ(significant(123.4), "123");
  EXPECT_EQ(significant(999.7),
            "1\xE2\x80\xAF"
            "000");
}

TEST(Markup, BytesHaveTheUnitThatSuits) {
  EXPECT_EQ(bytes_text(999),
            "999\xC2\xA0"
            "bytes");
  EXPECT_EQ(bytes_text(1'234), "1.23\xC2\xA0kB");
  EXPECT_EQ(bytes_text(999'999), "1.00\xC2\xA0MB");
  EXPECT_EQ(bytes_text(12'345'678), "12.3\xC2\xA0MB");
}

TEST(Markup, DataKeepTheExactNumber) {
  EXPECT_EQ(count_data(1'234'567),
            "<data value=\"1234567\">1\xE2\x80\xAF"
            "234\xE2\x80\xAF"
            "567</data>");
  EXPECT_EQ(number_data(0.1 + 0.2), "<data value=\"0.30000000000000004\">0.300</data>");
}

}  // namespace
}  // namespace vitrine::server
