// SPDX-License-Identifier: Apache-2.0
// Tests a daemon that drives several scanners.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "support/fake_backend.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using nlohmann::json;

TEST(ScannersOfADaemon, EachIsCommandedByItsName) {
  test::FakeScanner left, right;
  left.name = "left", right.name = "right";
  std::vector<std::unique_ptr<ScannerBackend>> both;
  for (test::FakeScanner* world : {&left, &right})
    both.push_back(std::make_unique<test::FakeBackend>(*world));
  test::LocalServer server(public_routes(), std::chrono::seconds(30), std::move(both));
  ASSERT_TRUE(server.scans().start());
  const std::string who = server.bearer(Role::kOperator);
  const auto ask = [&](const std::string& method, const std::string& path, const json& body) {
    const std::string text = body.dump();
    test::HttpClient client(server.port());
    client.send(method + " /api/v1" + path + " HTTP/1.1\r\nHost: a\r\n" + who +
                "Content-Type: application/json\r\nContent-Length: " + std::to_string(text.size()) +
                "\r\n\r\n" + text);
    return client.receive();
  };
  EXPECT_EQ(json::parse(ask("GET", "/scanners", json::object()).body)["scanners"].size(), 2u);
  EXPECT_EQ(ask("POST", "/scanners/right/jog", {{"degrees", 5}}).status, 200);
  EXPECT_EQ(right.degrees, 5);
  EXPECT_EQ(left.degrees, 0);
  test::HeldAtStep hold(left, 3);
  EXPECT_EQ(ask("POST", "/scans", {{"scanner", "left"}, {"steps", 12}}).status, 202);
  hold.await();
  EXPECT_EQ(ask("POST", "/scans", {{"scanner", "left"}, {"steps", 12}}).status, 409);
  EXPECT_EQ(ask("POST", "/scans", {{"scanner", "right"}, {"steps", 12}}).status, 202);
  server.scans().jobs().executor("right").run([] {});
  EXPECT_EQ(right.steps, 12) << "while the other one is at work";
  EXPECT_EQ(left.steps, 3);
  EXPECT_EQ(ask("POST", "/scanners/right/stop", json::object()).status, 200);
  EXPECT_TRUE(right.stopped());
  EXPECT_FALSE(left.stopped());
  hold.open();
  server.scans().jobs().executor("left").run([] {});
  EXPECT_EQ(left.steps, 12);
}

TEST(ScannersOfADaemon, TellTheStateOfLaserAndMotorAndGoDarkWithTheTokenThatLitThem) {
  test::FakeScanner rig;
  std::vector<std::unique_ptr<ScannerBackend>> one;
  one.push_back(std::make_unique<test::FakeBackend>(rig));
  test::LocalServer server(public_routes(), std::chrono::seconds(30), std::move(one));
  ASSERT_TRUE(server.scans().start());
  const std::string who = server.bearer(Role::kOperator);
  const auto ask = [&](const std::string& request, const std::string& body = "") {
    test::HttpClient client(server.port());
    client.send(request + " HTTP/1.1\r\nHost: a\r\n" + who +
                "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
                "\r\n\r\n" + body);
    return json::parse(client.receive().body);
  };
  const json before = ask("GET /api/v1/scanners/rig");
  EXPECT_EQ(before["laser"]["state"], "off");
  EXPECT_EQ(before["motor"]["state"], "off");
  const json lit = ask("POST /api/v1/scanners/rig/laser", R"({"on": true})");
  EXPECT_EQ(lit["laser"]["state"], "on");
  EXPECT_NE(lit["laser"]["since"], nullptr);
  EXPECT_EQ(ask("GET /api/v1/scanners")["scanners"][0]["laser"], lit["laser"]);

  const auto tokens = server.catalogue().tokens();
  ASSERT_TRUE(tokens && tokens->size() == 1);
  ASSERT_TRUE(server.catalogue().revoke_token(tokens->front().id));
  server.services().tokens.forget();
  server.scans().scanner("rig")->watch_manual_laser();
  server.scans().jobs().executor("rig").run([] {});
  EXPECT_FALSE(rig.laser);
}

}  // namespace
}  // namespace vitrine::server
