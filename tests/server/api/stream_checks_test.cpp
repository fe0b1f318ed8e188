// SPDX-License-Identifier: Apache-2.0
// Tests that one sweep of the server ends the streams that may no longer continue, and that the
// sweeps are frequent. Together these end a stream within a second, without a test of times.
#include <gtest/gtest.h>

#include "server/api/routes.h"
#include "server/store/change.h"
#include "support/hierarchies.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/stored_model.h"

namespace vitrine::server {
namespace {

using test::WebSocketClient;
using test::WebSocketFrame;

std::vector<std::uint8_t> sheet_file(unsigned size) {
  return test::store_model(test::on_lattice(test::sheet(size, size)), {}).file;
}

// A server that sweeps only when the test tells it to, and a stream of its model. Each test needs a
// new server, because a sweep starts no check while the previous check runs.
class StreamChecks : public testing::Test {
 protected:
  StreamChecks() { EXPECT_EQ(stream_.receive().kind, WebSocketFrame::kText); }

  void change(const std::string& method, const std::string& path, const std::string& body = "") {
    const std::string fields =
        "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
        "\r\n" + operator_;
    test::HttpClient client(server_.port());
    client.send(method + " /api/v1/models/" + id_.to_string() + path + " HTTP/1.1\r\nHost: a\r\n" +
                fields + "\r\n" + body);
    EXPECT_LT(client.receive().status, 300) << path;
  }
  // Waits up to 20 s for the close frame of the stream.
  void expect_that_one_sweep_ends_the_stream() {
    server_.sweep();
    EXPECT_EQ(stream_.receive().kind, WebSocketFrame::kClose);
  }

  test::LocalServer server_{
      public_routes(), std::chrono::seconds(30), {}, {.sweep_interval = std::chrono::hours(24)}};
  const std::string operator_ = server_.bearer(Role::kOperator);
  const ModelId id_ =
      publish(server_.store(), server_.catalogue(), sheet_file(24), {.title = "A"})->id;
  WebSocketClient stream_{server_.port(), "/api/v1/models/" + id_.to_string() + "/stream",
                          "pmesh.v1"};
};

TEST_F(StreamChecks, OneEndsTheStreamOfAModelThatWasWithdrawn) {
  change("POST", "/unpublish");
  expect_that_one_sweep_ends_the_stream();
}

TEST_F(StreamChecks, OneEndsTheStreamOfAModelThatWasCapped) {
  change("PATCH", "", R"({"public_max_level": 0})");
  expect_that_one_sweep_ends_the_stream();
}

TEST_F(StreamChecks, OneEndsTheStreamOfAModelWhoseFileWasReplaced) {
  ASSERT_TRUE(replace(server_.store(), server_.catalogue(), sheet_file(30), {}, {.id = id_}));
  server_.services().models.refresh();
  expect_that_one_sweep_ends_the_stream();
}

TEST(HttpOptions, ASweepAndACheckTakePlaceWithinASecond) {
  EXPECT_LE(HttpOptions{}.sweep_interval, std::chrono::milliseconds(500));
}

}  // namespace
}  // namespace vitrine::server
