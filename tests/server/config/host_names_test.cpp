// SPDX-License-Identifier: Apache-2.0
#include "server/config/host_names.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

Settings museum() {
  return {.hosts = {"intranet", "www.museum.example"},
          .scan_address = "http://scanner.museum.lan:8080",
          .public_url = "https://Museum.example:8443/3d"};
}

TEST(HostNames, TheConfiguredNamesAndAddressesAreTheDaemonsOwn) {
  for (const char* host :
       {"museum.example", "MUSEUM.example:8443", "museum.example.", "intranet", "intranet:80",
        "www.museum.example", "scanner.museum.lan:8080", "localhost", "localhost:8080", "192.0.2.7",
        "192.0.2.7:8080", "[2001:db8::1]", "[::1]:8080", ""})
    EXPECT_TRUE(is_own_host(museum(), host)) << host;
}

TEST(HostNames, NamesThatADnsServerOfOthersCanResolveAreNot) {
  for (const char* host : {"attacker.example", "museum.example.attacker.example",
                           "notmuseum.example", "museum", "localhost.attacker.example",
                           "127.0.0.1.attacker.example", "[attacker.example]", "[", "x:"})
    EXPECT_FALSE(is_own_host(museum(), host)) << host;
}

TEST(HostNames, TheAdminListenerNeedsEveryNameSetAndThePublicOneOnlyIfAnyIs) {
  const Settings unset;
  EXPECT_FALSE(is_own_host(unset, "museum.example"));
  EXPECT_TRUE(is_public_host(unset, "museum.example"));
  EXPECT_FALSE(is_public_host({.hosts = {"intranet"}}, "museum.example"));
  EXPECT_FALSE(is_public_host({.public_url = "https://museum.example"}, "attacker.example"));
  EXPECT_TRUE(is_public_host({.public_url = "https://museum.example"}, "museum.example"));
}

}  // namespace
}  // namespace vitrine::server
