// SPDX-License-Identifier: Apache-2.0
// Tests that the jobs of two tokens take turns if one of them has ordered many reprocessing jobs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "support/fake_backend.h"
#include "support/held_executor.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using nlohmann::json;

class ReprocessTurns : public testing::Test {
 protected:
  ReprocessTurns() { EXPECT_TRUE(server_.scans().start()); }

  static std::vector<std::unique_ptr<ScannerBackend>> one(test::FakeScanner& world) {
    std::vector<std::unique_ptr<ScannerBackend>> backends;
    backends.push_back(std::make_unique<test::FakeBackend>(world));
    return backends;
  }
  // Sends an order and returns the response's JSON.
  json post(const std::string& path, const std::string& who, const json& order) {
    const std::string body = order.dump();
    test::HttpClient client(server_.port());
    client.send("POST /api/v1" + path + " HTTP/1.1\r\nHost: a\r\n" + who +
                "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
                "\r\n\r\n" + body);
    const test::HttpAnswer answer = client.receive();
    EXPECT_EQ(answer.status, 202) << answer.body;
    return json::parse(answer.body);
  }
  // Returns the path of a new scan that has ended.
  std::string new_scan() {
    const json started = post("/scans", one_, {{"scanner", "rig"}, {"steps", 12}});
    server_.scans().jobs().executor("rig").run([] {});
    return "/scans/" + started["id"].get<std::string>();
  }

  test::FakeScanner world_;
  test::LocalServer server_{public_routes(), std::chrono::seconds(30), one(world_)};
  const std::string one_ = server_.bearer(Role::kOperator);
  const std::string other_ = server_.bearer(Role::kOperator);
};

TEST_F(ReprocessTurns, ATokenWithManyOrdersDelaysAnotherTokenByOneJob) {
  std::vector<std::string> order;
  world_.while_rebuilding = [&](const ScanOrder& rebuilt) {
    order.push_back(rebuilt.metadata.title);
  };
  std::vector<std::string> scans;
  for (int i = 0; i < 4; ++i)
    scans.push_back(new_scan());
  auto& builds = server_.scans().jobs().executor("");
  {
    const test::HeldExecutor held(builds);
    for (std::size_t i = 0; i < 3; ++i) {
      post(scans[i] + "/reprocess", one_,
           {{"metadata", {{"title", "one " + std::to_string(i + 1)}}}});
    }
    post(scans[3] + "/reprocess", other_, {{"metadata", {{"title", "other"}}}});
  }
  builds.run([] {});
  EXPECT_THAT(order, testing::ElementsAre("one 1", "other", "one 2", "one 3"));
}

}  // namespace
}  // namespace vitrine::server
