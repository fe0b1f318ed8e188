// SPDX-License-Identifier: Apache-2.0
// Tests for which host names the daemon answers requests. An attacker's DNS server may resolve
// another name to the daemon's address (DNS rebinding). The daemon must refuse requests under that
// name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;

HttpAnswer ask_host(std::uint16_t port, const std::string& target, const std::string& host) {
  HttpClient client(port);
  client.send("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
  return client.receive();
}

TEST(Hosts, TheAdminListenerAnswersAddressesAndTheNamesThatAreSet) {
  const ServedFolder folder;
  const Daemon daemon(folder.path(), {"--hosts", "metrics.museum.lan"});
  const std::string port = ":" + std::to_string(daemon.admin_port());
  for (const char* host : {"127.0.0.1", "localhost", "metrics.museum.lan"})
    EXPECT_EQ(ask_host(daemon.admin_port(), "/metrics", host + port).status, 200) << host;
  for (const char* host : {"[::1]attacker.example", "[127.0.0.1", "localhost:attacker",
                           "localhost:80@attacker.example"})
    EXPECT_EQ(ask_host(daemon.admin_port(), "/metrics", host).status, 421) << host;
  const HttpAnswer refused = ask_host(daemon.admin_port(), "/metrics", "attacker.example" + port);
  EXPECT_EQ(refused.status, 421);
  EXPECT_THAT(refused.body, HasSubstr("'hosts'"));
  EXPECT_EQ(refused.field("access-control-allow-origin"), "");
}

TEST(Hosts, NoPageReadsTheAdminListener) {
  const ServedFolder folder;
  const Daemon daemon(folder.path());
  for (const char* target : {"/metrics", "/livez", "/readyz", "/nothing"}) {
    HttpClient client(daemon.admin_port());
    client.send(std::string("GET ") + target +
                " HTTP/1.1\r\nHost: localhost\r\nOrigin: https://attacker.example\r\n\r\n");
    const HttpAnswer answer = client.receive();
    EXPECT_EQ(answer.field("access-control-allow-origin"), "") << target;
    EXPECT_EQ(answer.field("cross-origin-resource-policy"), "") << target;
  }
}

TEST(Hosts, TheAdminListenerAnswersNoNameByDefaultAndThePublicOneAll) {
  const ServedFolder folder;
  const Daemon daemon(folder.path());
  EXPECT_EQ(ask_host(daemon.admin_port(), "/metrics", "attacker.example").status, 421);
  EXPECT_EQ(ask_host(daemon.port(), "/api/v1/models", "museum.example").status, 200);
}

TEST(Hosts, WithAPublicUrlOtherNamesAreRefusedUntilAReloadAddsThem) {
  const ServedFolder folder;
  const std::string config = (folder.path() / "vitrine.conf").string();
  std::ofstream(config) << "public-url = https://museum.example\n";
  Daemon daemon(folder.path(), {"--config", config});
  const auto status = [&](const std::string& host) {
    return ask_host(daemon.port(), "/api/v1/models", host).status;
  };
  EXPECT_EQ(status("museum.example"), 200);
  EXPECT_EQ(status("127.0.0.1:8080"), 200);
  EXPECT_EQ(status("intranet"), 421);
  std::ofstream(config) << "public-url = https://museum.example\nhosts = intranet\n";
  daemon.signal(SIGHUP);
  daemon.wait_for_line("configuration read again");
  EXPECT_EQ(status("intranet"), 200);
  EXPECT_EQ(status("attacker.example"), 421);
}

}  // namespace
}  // namespace vitrine::test
