// SPDX-License-Identifier: Apache-2.0
// Tests the deletion of a scan's data over HTTP.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "support/fake_backend.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using nlohmann::json;

class ScanData : public testing::Test {
 protected:
  ScanData() { EXPECT_TRUE(server_.scans().start()); }

  static std::vector<std::unique_ptr<ScannerBackend>> one(test::FakeScanner& world) {
    std::vector<std::unique_ptr<ScannerBackend>> backends;
    backends.push_back(std::make_unique<test::FakeBackend>(world));
    return backends;
  }
  test::HttpAnswer ask(const std::string& method, const std::string& path, const std::string& who,
                       const std::string& body = "") {
    test::HttpClient client(server_.port());
    client.send(method + " /api/v1" + path + " HTTP/1.1\r\nHost: a\r\n" + who +
                (body.empty() ? "" : "Content-Type: application/json\r\n") +
                "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return client.receive();
  }
  unsigned status(const std::string& method, const std::string& path) {
    return static_cast<unsigned>(ask(method, path, operator_).status);
  }

  test::FakeScanner world_;
  test::LocalServer server_{public_routes(), std::chrono::seconds(30), one(world_)};
  const std::string operator_ = server_.bearer(Role::kOperator);
};

TEST_F(ScanData, IsDeletedByAnOperatorAndTheModelStays) {
  test::HeldAtStep held(world_, 3);
  const std::string order = R"({"scanner": "rig", "steps": 12, "publish": true})";
  const std::string id = json::parse(ask("POST", "/scans", operator_, order).body)["id"];
  const std::string scan = "/scans/" + id, data = scan + "/data";
  const auto folder = server_.data() / "scans" / id;
  held.await();
  EXPECT_EQ(status("DELETE", data), 409u) << "the scan runs";
  held.open();
  server_.scans().jobs().executor("rig").run([] {});  // returns once the scan has ended
  EXPECT_EQ(status("GET", scan + "/points"), 200u);
  EXPECT_EQ(ask("DELETE", data, "").status, 401);
  EXPECT_EQ(ask("DELETE", data, server_.bearer(Role::kViewer)).status, 403);
  EXPECT_TRUE(std::filesystem::exists(folder));
  EXPECT_EQ(status("DELETE", data), 204u);
  EXPECT_TRUE(std::filesystem::is_empty(folder.parent_path()));
  EXPECT_EQ(status("GET", scan + "/points"), 409u);
  EXPECT_EQ(status("GET", scan + "/profile"), 409u);
  EXPECT_EQ(ask("POST", scan + "/reprocess", operator_, "{}").status, 409);
  EXPECT_EQ(status("DELETE", data), 409u) << "there is no data left";
  const json record = json::parse(ask("GET", scan, operator_).body);
  EXPECT_EQ(record["state"], "done");
  EXPECT_EQ(status("GET", "/models/" + record["model"].get<std::string>()), 200u);
}

}  // namespace
}  // namespace vitrine::server
