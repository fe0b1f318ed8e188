// SPDX-License-Identifier: Apache-2.0
#include "server/messages/client.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

using Fields = std::vector<std::pair<const char*, const char*>>;

Client visitor(const Fields& fields, const char* peer = "10.0.0.1", bool is_encrypted = false) {
  RequestHeader header;
  for (const auto& [name, value] : fields)
    header.insert(name, value);
  return client_of({peer, is_encrypted}, header, Networks::parse("10.0.0.0/8, unix").value());
}

TEST(Client, IsThePeerWhereNoTrustedProxySaysOtherwise) {
  EXPECT_EQ(visitor({}).address, "10.0.0.1");
  EXPECT_EQ(visitor({{"X-Forwarded-For", "192.0.2.1"}}, "203.0.113.9").address, "203.0.113.9");
  EXPECT_FALSE(visitor({{"X-Forwarded-Proto", "https"}}, "203.0.113.9").is_encrypted);
}

TEST(Client, IsTheLastAddressThatIsNoTrustedProxys) {
  EXPECT_EQ(visitor({{"X-Forwarded-For", "192.0.2.1"}}).address, "192.0.2.1");
  EXPECT_EQ(visitor({{"X-Forwarded-For", "1.1.1.1, 192.0.2.1, 10.0.0.2"}}).address, "192.0.2.1");
  EXPECT_EQ(visitor({{"X-Forwarded-For", "1.1.1.1"}, {"X-Forwarded-For", "192.0.2.1"}}).address,
            "192.0.2.1");
  EXPECT_EQ(visitor({{"X-Forwarded-For", "10.0.0.3, 10.0.0.2"}}).address, "10.0.0.3");
  EXPECT_EQ(visitor({{"X-Forwarded-For", "2001:db8::1"}}, "unix").address, "2001:db8::1");
}

TEST(Client, IsReadFromForwardedWhereThereIsNothingElse) {
  EXPECT_EQ(visitor({{"Forwarded", "for=192.0.2.1;proto=https"}}).address, "192.0.2.1");
  EXPECT_TRUE(visitor({{"Forwarded", "for=192.0.2.1;Proto=https"}}).is_encrypted);
  EXPECT_EQ(visitor({{"Forwarded", "for=1.1.1.1, For=\"[2001:db8::1]:80\";by=10.0.0.9"}}).address,
            "2001:db8::1");
}

TEST(Client, WhatDoesNotParseEndsTheSearch) {
  for (const char* text : {"unknown", "", "192.0.2.1 evil", "1.1.1.1, _hidden", "\n", ",,,"})
    EXPECT_EQ(visitor({{"X-Forwarded-For", text}}).address, "10.0.0.1") << text;
}

TEST(Client, IsEncryptedAsTheNearestProxySays) {
  EXPECT_TRUE(visitor({{"X-Forwarded-Proto", "https"}}).is_encrypted);
  EXPECT_FALSE(visitor({{"X-Forwarded-Proto", "https, http"}}).is_encrypted);
  EXPECT_FALSE(visitor({{"X-Forwarded-Proto", "http"}}, "10.0.0.1", true).is_encrypted);
  EXPECT_TRUE(visitor({}, "10.0.0.1", true).is_encrypted);
}

}  // namespace
}  // namespace vitrine::server
