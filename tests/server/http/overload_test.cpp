// SPDX-License-Identifier: Apache-2.0
// More work than there is room for.
#include <gtest/gtest.h>

#include <semaphore>
#include <thread>

#include "server/http/http_server.h"
#include "server/http/services.h"
#include "server/store/installation.h"
#include "support/http_client.h"
#include "support/temporary_folder.h"

namespace vitrine {
namespace {

std::binary_semaphore entered{0}, may_end{0};

Response wait_for_the_test(const Request&, Services&) {
  entered.release();
  may_end.acquire();
  return {};
}

constexpr Route kRoutes[] = {{Method::kGet, "/slow", wait_for_the_test, Place::kExport}};

// A server with one seat for exports.
class Server {
 public:
  Server() : port_(server_.listen({"127.0.0.1", 0}).value()) {
    server_.start();
    thread_ = std::thread([this] { io_.run(); });
  }
  ~Server() {
    io_.stop();
    thread_.join();
    workers_.stop();
    workers_.join();
  }
  std::uint16_t port() const { return port_; }

 private:
  test::TemporaryFolder folder_;
  Installation installation_ = open_installation(folder_.path()).value();
  PublishedModels models_{*installation_.store, *installation_.catalogue};
  ExportCache exports_{0};
  WebPages pages_{{}};
  Metrics metrics_{std::vector<std::string_view>{"/slow"}};
  Authenticator tokens_{*installation_.catalogue};
  Log log_ = Log::open("").value();
  Services services_{
      *installation_.catalogue, tokens_, models_, exports_, pages_, metrics_, log_, log_, true};
  asio::io_context io_;
  Workers workers_{2, 1};
  HttpServer server_{io_, services_, workers_, {.routes = kRoutes, .max_connections = 8}};
  std::uint16_t port_;
  std::thread thread_;
};

TEST(Overload, AFullExportQueueIsAnsweredWithRetryAfterUntilASeatIsFree) {
  const Server server;
  test::HttpClient first(server.port());
  first.send("GET /slow HTTP/1.1\r\nHost: a\r\n\r\n");
  entered.acquire();
  const test::HttpAnswer refused = test::http_get(server.port(), "/slow");
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(refused.field("retry-after"), "5");
  EXPECT_EQ(refused.field("content-type"), "application/problem+json");
  may_end.release();
  EXPECT_EQ(first.receive().status, 200);
  may_end.release();
  EXPECT_EQ(test::http_get(server.port(), "/slow").status, 200);
}

}  // namespace
}  // namespace vitrine
