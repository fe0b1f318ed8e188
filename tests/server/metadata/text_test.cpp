// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/text.h"

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

TEST(Lines, AreJoinedAsPlainTextAndSplitAgain) {
  const std::vector<std::string> lines = {"1 face of B\u00fcste dropped", "two\nlines \x1b[2J"};
  const std::string text = joined_lines(lines);
  EXPECT_EQ(text, lines[0] + "\ntwo\\x0alines \\x1b[2J");
  EXPECT_EQ(lines_of(text), (std::vector<std::string>{lines[0], "two\\x0alines \\x1b[2J"}));
  EXPECT_EQ(joined_lines({}), "");
  EXPECT_EQ(lines_of("").size(), 0u);
}

TEST(Lines, ThatDoNotFitAreCounted) {
  const std::vector<std::string> lines(100, std::string(1'000, 'x'));
  const std::string text = joined_lines(lines);
  EXPECT_TRUE(is_paragraphs(text));
  EXPECT_EQ(lines_of(text).size(), 17u);
  EXPECT_EQ(lines_of(text).back(), "… and 84 more; `vitrine build` lists all");
}

TEST(Lines, ThatAreTooLongDoNotHideTheOthers) {
  EXPECT_EQ(joined_lines(std::vector{std::string(kMaxParagraphBytes, 'x'), std::string("short")}),
            "short\n… and 1 more; `vitrine build` lists all");
}

}  // namespace
}  // namespace vitrine::server
