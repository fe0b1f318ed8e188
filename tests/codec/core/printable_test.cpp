// SPDX-License-Identifier: Apache-2.0
#include "codec/core/printable.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

TEST(Printable, LettersOfAllScriptsStay) {
  for (const std::string text :
       {"B\xC3\xBCste.png", "\xD0\xB1\xD1\x8E\xD1\x81\xD1\x82", "\xE5\x83\x8F \xF0\x9F\x97\xBF"}) {
    EXPECT_TRUE(is_utf8(text));
    EXPECT_EQ(printable_text(text), text);
  }
}

TEST(Printable, ControlCharactersAndOtherBytesBecomeQuestionMarks) {
  EXPECT_EQ(printable_text("a\n\x1B[2J\x7F"), "a??[2J?");
  EXPECT_EQ(printable_text("a\xC2\x85"), "a?");                // next line, U+0085
  EXPECT_EQ(printable_text("gnp.\xE2\x80\xAE"), "gnp.?");      // right-to-left override, U+202E
  EXPECT_EQ(printable_text("\xC0\xAF\xED\xA0\x80"), "?????");  // overlong UTF-8, and a surrogate
  EXPECT_EQ(printable_text("\xF4\x90\x80\x80 \xE5\x83"), "???? ??");
  EXPECT_FALSE(is_utf8("B\xFCste"));
}

TEST(Printable, QuotesDoNotCutWithinACharacter) {
  const std::string letters(59, 'a');
  EXPECT_EQ(in_quotes(letters + "\xC3\xBC"), '\'' + letters + '\'');
  EXPECT_EQ(in_quotes(letters.substr(1) + "\xC3\xBC" + "b"),
            '\'' + letters.substr(1) + "\xC3\xBC'");
  EXPECT_EQ(in_quotes(letters + "bc"), '\'' + letters + "b'");
  EXPECT_EQ(in_quotes(""), "''");
}

}  // namespace
}  // namespace vitrine
