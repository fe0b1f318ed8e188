// SPDX-License-Identifier: Apache-2.0
#include "server/config/networks.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(Networks, AnAddressIsInItselfAndInItsPrefix) {
  const auto networks = Networks::parse("127.0.0.1, 10.1.0.0/15,2001:db8::/33").value();
  for (const char* inside :
       {"127.0.0.1", "10.0.255.1", "10.1.2.3", "2001:db8:7fff::1", "::ffff:127.0.0.1"})
    EXPECT_TRUE(networks.contain(inside)) << inside;
  for (const char* outside :
       {"127.0.0.2", "10.2.0.0", "2001:db8:8000::1", "unix", "", "-", "127.0.0.1.", "localhost"})
    EXPECT_FALSE(networks.contain(outside)) << outside;
}

TEST(Networks, ThePrefixOfNoLengthHoldsAllOfItsKind) {
  const auto networks = Networks::parse("0.0.0.0/0").value();
  EXPECT_TRUE(networks.contain("203.0.113.9"));
  EXPECT_FALSE(networks.contain("2001:db8::1"));
}

TEST(Networks, UnixMeansClientsOnAUnixSocket) {
  EXPECT_TRUE(Networks::parse("unix")->contain("unix"));
  EXPECT_FALSE(Networks::parse("")->contain("unix"));
}

TEST(Networks, LimitsCountAnIpv4AddressAndTheFirstHalfOfAnIpv6Address) {
  EXPECT_EQ(network_of("192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(network_of("::ffff:192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(network_of("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::/64");
  EXPECT_EQ(network_of("2001:db8:1:2::1"), network_of("2001:db8:1:2:ffff::"));
  EXPECT_NE(network_of("2001:db8:1:2::1"), network_of("2001:db8:1:3::1"));
  EXPECT_EQ(network_of("unix"), "unix");
}

TEST(Networks, AShortenedAddressIsThatOfManySubscribers) {
  EXPECT_EQ(shortened("192.0.2.7"), "192.0.2.0/24");
  EXPECT_EQ(shortened("::ffff:192.0.2.7"), "192.0.2.0/24");
  EXPECT_EQ(shortened("2001:db8:1:2:3:4:5:6"), "2001:db8:1::/48");
  EXPECT_EQ(shortened("::1"), "::/48");
  EXPECT_EQ(shortened("unix"), "unix");
}

TEST(Networks, AnEntryThatIsNoNetworkIsNamed) {
  for (const char* text : {"10.0.0.0/33", "::/129", "10.0.0/8", "10.0.0.0/", "10.0.0.0/8x", "proxy",
                           "10.0.0.1,,10.0.0.2", "10.0.0.0/-1"})
    EXPECT_FALSE(Networks::parse(text)) << text;
  EXPECT_EQ(Networks::parse("10.0.0.1, proxy").error().message,
            "'proxy' is not a network; give, for example, 10.0.0.0/8");
}

}  // namespace
}  // namespace vitrine::server
