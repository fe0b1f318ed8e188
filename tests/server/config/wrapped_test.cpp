// SPDX-License-Identifier: Apache-2.0
#include "server/config/help_text.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(Wrapped, AShortTextStaysOnOneLine) {
  EXPECT_EQ(wrapped("two words", 36), "two words");
  EXPECT_EQ(wrapped(std::string(64, 'x'), 36), std::string(64, 'x'));
}

TEST(Wrapped, ALongTextIsBrokenAtTheLastSpaceThatFits) {
  const std::string first(30, 'a'), second(40, 'b');
  EXPECT_EQ(wrapped(first + " " + second, 36), first + "\n" + std::string(36, ' ') + second);
}

TEST(Wrapped, AWordThatIsTooLongStaysWhole) {
  const std::string word(80, 'x');
  EXPECT_EQ(wrapped(word + " y", 36), word + "\n" + std::string(36, ' ') + "y");
  EXPECT_EQ(wrapped(word, 36), word);
}

}  // namespace
}  // namespace vitrine::server
