// SPDX-License-Identifier: Apache-2.0
#include "server/config/help_text.h"

#include <gtest/gtest.h>

#include <array>

namespace vitrine::server {
namespace {

constexpr std::array<std::string_view, 3> kWords = {"listen", "admin-listen", "data"};

TEST(Suggest, FindsTheWordWithTwoLettersSwapped) {
  EXPECT_EQ(suggest("lisetn", kWords), "listen");
}
TEST(Suggest, FindsTheWordWithALetterMissing) {
  EXPECT_EQ(suggest("admn-listen", kWords), "admin-listen");
}
TEST(Suggest, StaysSilentWhenNothingIsNear) {
  EXPECT_EQ(suggest("zzzzzz", kWords), "");
}

}  // namespace
}  // namespace vitrine::server
