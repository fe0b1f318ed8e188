// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/id.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(ModelId, GeneratedIdsDifferAndSurviveTheirText) {
  const ModelId a = ModelId::generate(), b = ModelId::generate();
  EXPECT_NE(a, b);
  EXPECT_EQ(a.to_string().size(), 26u);
  EXPECT_EQ(ModelId::parse(a.to_string()), a);
}

TEST(ModelId, TheTextIsTheUlidOfTheBytes) {
  std::array<std::uint8_t, 16> bytes{};
  bytes.fill(0xFF);
  EXPECT_EQ(ModelId::from_bytes(bytes).to_string(), "7zzzzzzzzzzzzzzzzzzzzzzzzz");
  bytes = {};
  bytes[15] = 33;
  EXPECT_EQ(ModelId::from_bytes(bytes).to_string(), "00000000000000000000000011");
}

TEST(ModelId, TextsSortAsIdsDo) {
  ModelId smaller = ModelId::generate(), larger = ModelId::generate();
  if (larger < smaller) std::swap(smaller, larger);
  EXPECT_LT(smaller.to_string(), larger.to_string());
}

TEST(ModelId, NothingElseIsAnId) {
  for (const char* text :
       {"", "0", "0000000000000000000000000", "000000000000000000000000000",
        "80000000000000000000000000", "0000000000000000000000000O", "0000000000000000000000000u",
        "../../../../../../etc/pass", "0000000000000000000000000A", "000000000000 0000000000000"}) {
    EXPECT_FALSE(ModelId::parse(text)) << text;
  }
  EXPECT_FALSE(ModelId::parse(std::string(13, '0') + '\0' + std::string(12, '0')));
}

}  // namespace
}  // namespace vitrine::server
