// SPDX-License-Identifier: Apache-2.0
#include "server/auth/token.h"

#include <gtest/gtest.h>

#include <set>

namespace vitrine::server {
namespace {

TEST(Token, IsAPrefixAndFortyThreeDigitsOfItsOwn) {
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i) {
    const std::string token = generate_token();
    EXPECT_EQ(token.size(), 47u);
    EXPECT_TRUE(token.starts_with("vtr_"));
    EXPECT_TRUE(token_hash(token)) << token;
    EXPECT_TRUE(seen.insert(token).second);
  }
}

TEST(Token, UsesEveryDigit) {
  std::set<char> digits;
  for (int i = 0; i < 200; ++i) {
    for (const char c : generate_token().substr(4))
      digits.insert(c);
  }
  EXPECT_EQ(digits.size(), 64u);
}

TEST(Token, ItsHashIsThatOfItsText) {
  const std::string token = "vtr_" + std::string(43, 'A');
  EXPECT_EQ(to_hex(*token_hash(token)),
            to_hex(sha256({reinterpret_cast<const std::uint8_t*>(token.data()), token.size()})));
}

TEST(Token, NothingElseHasAHash) {
  const std::string digits(42, 'A');
  for (const std::string& text :
       {std::string(), "vtr_" + digits, "vtr_" + digits + "AA", "vtr_" + digits + "=",
        "vtr_" + digits + "+", "VTR_" + digits + "A", "vtx_" + digits + "A", "vtr_" + digits + '\0',
        std::string(1 << 20, 'A')}) {
    EXPECT_FALSE(token_hash(text)) << text.substr(0, 60);
  }
}

}  // namespace
}  // namespace vitrine::server
