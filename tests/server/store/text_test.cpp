// SPDX-License-Identifier: Apache-2.0
#include "server/store/text.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(PlainText, KeepsWhatIsPlain) {
  for (const char* text : {"", "a \"b\" \\x", "Büste 半身像 🗿"})
    EXPECT_EQ(as_plain_text(text), text);
}

TEST(PlainText, ReplacesControlCharactersAndBytesThatAreNotUtf8) {
  EXPECT_EQ(as_plain_text("a\nb\t\x1b[2J\x7f"), "a\\x0ab\\x09\\x1b[2J\\x7f");
  EXPECT_EQ(as_plain_text("b\xfcste"), "b\\xfcste");
  EXPECT_EQ(as_plain_text("\xc2\x9b"
                          "1m"),
            "\\xc2\\x9b1m");  // a control sequence in UTF-8
  EXPECT_EQ(as_plain_text("cut \xe5\x8d"), "cut \\xe5\\x8d");
  EXPECT_EQ(as_plain_text("\xc0\xaf \xed\xa0\x80"), "\\xc0\\xaf \\xed\\xa0\\x80");
}

TEST(PlainText, IsPlainForAllBytes) {
  std::string all;
  for (int byte = 0; byte < 256; ++byte)
    all += static_cast<char>(byte);
  EXPECT_TRUE(is_plain_text(as_plain_text(all)));
}

}  // namespace
}  // namespace vitrine::server
